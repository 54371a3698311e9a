// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed, walls and contact points of a scene in one place.
#include "solver/integrator/surroundings.hpp"

#include "solver/options/solve.hpp"
#include "solver/scene/settings.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slope of 1 in 2 on a Cartesian grid whose datum is 4 m, without contact points or with some of an obstacle.
struct Slope {
  Scene scene;
  IntegratorSettings settings;

  explicit Slope(int contacts) {
    Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 9.75 - 0.5 * x; });
    fill(d, {4, 6, 4, 6, 0, 1});
    SolveOptions o;
    o.mapping = Mapping::cartesian;
    o.base.friction_angle = 45;
    scene = make_scene(d, o);
    for (int c = 0; c < contacts; ++c) {
      for (int a = 0; a < 3; ++a) {
        scene.contacts.cell[a].push_back(4 + c);
        scene.contacts.offset[a].push_back(0.1);
      }
      scene.contacts.normal.push_back({0, 0, 1});
      scene.contacts.area.push_back(0.25);
      scene.contacts.body.push_back(0);
    }
    if (contacts > 0) scene.contacts.friction = {0.4};
    settings = make_settings(o, scene.grid).common;
    settings.walls = {{.axis = 0, .position = 7.5, .to = 2}, {.axis = 2, .position = 6, .to = 9}};
  }
  Surroundings<double, CpuDevice, Linear> make(const ContactState& state = {}) const {
    return {CpuDevice::make(), scene, settings, state, 4};
  }
};

TEST(Surroundings, have_the_walls_of_a_time_in_cells_from_the_first_node_and_the_datum) {
  const Slope slope(0);
  const auto surroundings = slope.make();
  const Walls<double> early = surroundings.walls<double>(1.5), later = surroundings.walls<double>(2.5);
  ASSERT_EQ(later.count, 1);
  EXPECT_EQ(later.list[0].position, 2);  // 6 m over the datum of 4 m
  ASSERT_EQ(early.count, 2);
  EXPECT_EQ(early.list[0].position, 7);  // nodes stand half a cell from the map's edge
}

TEST(Surroundings, have_contact_points_where_there_are_obstacles) {
  const Slope bare(0), with_obstacle(3);
  auto none = bare.make();
  EXPECT_FALSE(none.contact().on());
  EXPECT_EQ(none.contact_bytes(), 0u);
  auto some = with_obstacle.make();
  ASSERT_TRUE(some.contact().on());
  EXPECT_EQ(some.contact().count(), 3);
  EXPECT_GT(some.contact_bytes(), 0u);
  EXPECT_EQ(some.contact().obstacle_impulses().size(), 1u);
}

TEST(Surroundings, have_the_friction_of_bed_and_obstacles) {
  const Slope slope(2);
  auto surroundings = slope.make();
  EXPECT_NEAR(surroundings.bed().uniform.numbers[0], 1, 1e-15);  // tan 45 deg
  EXPECT_EQ(surroundings.contact().view().friction(1), 0.4);
  EXPECT_EQ(surroundings.bed_bytes(), 0u) << "the bed is the same everywhere";
}

TEST(Surroundings, go_on_from_what_contact_points_gave_before) {
  const Slope slope(5);
  ContactState state;
  for (std::size_t c = 0; c < slope.scene.contacts.size(); ++c) {
    for (int a = 0; a < 3; ++a) state.force.push_back(static_cast<double>(3 * c) + a);
  }
  state.impulse = state.force;
  const auto surroundings = slope.make(state);
  EXPECT_EQ(surroundings.contact().state().force, state.force);
  EXPECT_EQ(surroundings.contact().state().impulse, state.impulse);
}

}  // namespace
}  // namespace talus::solver::testing
