// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points of the surfaces of obstacles: on the host, on a device, and as kernels see them.
#include "solver/boundary/contact_points.hpp"

#include "solver/boundary/contact_arrays.hpp"
#include "solver/boundary/contact_view.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(ContactPoints, refuse_an_obstacle_without_a_file) {
  Domain d = ground(14, 12, 2, 1.0, [](double x, double y) { return 20 + 0.3 * x - 0.2 * y; });
  fill(d, {10, 14, 8, 12, 0, 2});
  const Scene scene = make_scene(d, {});
  EXPECT_EQ(scene.contacts.size(), 0u) << "there are no points without obstacles";
  EXPECT_THROW(
      make_contact_points(scene.map, scene.grid, make_terrain_tables(scene.grid), {{"pier", "/no/such.vdb", "", 0}}),
      DataError);
}

/// Two points, one of each obstacle.
ContactPoints two_points() {
  ContactPoints points;
  for (int a = 0; a < 3; ++a) {
    points.cell[a] = {3 + a, 7 + a};
    points.offset[a] = {0.1 * a, -0.2 * a};
  }
  points.normal = {{0.6, 0, 0.8}, {0, 0, 1}};
  points.area = {0.3, 0.7};
  points.body = {0, 1};
  points.friction = {0.9, 0.2};
  return points;
}

TEST(ContactArrays, show_kernels_every_number_of_the_points) {
  const ContactPoints points = two_points();
  ContactArrays<float, CpuDevice> arrays(CpuDevice::make(), points, {});
  const ContactView<float> view = arrays.view();
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(view.places.cell[a][c], points.cell[a][c]);
      EXPECT_EQ(view.places.offset[a][c], static_cast<float>(points.offset[a][c]));
      EXPECT_EQ(view.places.extent[a][c], 0);
    }
    EXPECT_EQ(view.normal[c].x, static_cast<float>(points.normal[c].x));
    EXPECT_EQ(view.normal[c].z, static_cast<float>(points.normal[c].z));
    EXPECT_EQ(view.area[c], static_cast<float>(points.area[c]));
    EXPECT_EQ(view.body[c], points.body[c]);
    EXPECT_EQ(view.inverse_mass[c], 0);
    EXPECT_EQ(length(view.force[c]), 0);
    EXPECT_EQ(length(view.impulse[c]), 0);
  }
  EXPECT_EQ(view.body_friction[0], 0.9F);
  EXPECT_EQ(view.friction(1), 0.2F);
}

TEST(ContactArrays, go_on_from_the_state_of_a_checkpoint) {
  const ContactState before{.force = {1, 2, 3, 4, 5, 6}, .impulse = {7, 8, 9, 10, 11, 12}};
  ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), two_points(), before);
  const ContactView<double> view = arrays.view();
  EXPECT_EQ(view.force[1].y, 5);
  EXPECT_EQ(view.impulse[0].z, 9);
  view.force[0] = {-1, 0, 0};
  view.impulse[1].x += 5;
  EXPECT_EQ(arrays.impulses()[1].x, 15);
  const ContactState after = arrays.state();
  EXPECT_EQ(after.force, (std::vector<double>{-1, 0, 0, 4, 5, 6}));
  EXPECT_EQ(after.impulse, (std::vector<double>{7, 8, 9, 15, 11, 12}));
}

TEST(ContactArrays, take_no_memory_without_points) {
  const ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), {}, {});
  EXPECT_EQ(arrays.bytes(), 0u);
  EXPECT_TRUE(arrays.state().force.empty());
}

using View = ContactView<double>;

TEST(ContactLaw, gives_what_is_required_where_it_pushes_and_does_not_slip) {
  const Vec3<double> required{3, 0, 10};
  const Vec3<double> given = View::hold(required, {0, 0, 1}, 0.5);
  EXPECT_EQ(given.x, 3);
  EXPECT_EQ(given.y, 0);
  EXPECT_EQ(given.z, 10);
}

TEST(ContactLaw, does_not_pull) {
  EXPECT_EQ(length(View::hold({3, 0, -1}, {0, 0, 1}, 0.5)), 0);
  EXPECT_EQ(length(View::hold({3, 0, 0}, {0, 0, 1}, 0.5)), 0);
}

TEST(ContactLaw, holds_slip_back_up_to_the_coefficient_times_the_push) {
  const Vec3<double> normal{0.6, 0, 0.8};
  const Vec3<double> given = View::hold(normal * 10 + Vec3<double>{0, 12, 0}, normal, 0.5);
  EXPECT_NEAR(dot(given, normal), 10, 1e-14);
  EXPECT_NEAR(length(given - normal * dot(given, normal)), 0.5 * 10, 1e-14);
  EXPECT_NEAR(given.y, 5, 1e-14);
}

/// The masses of the nodes of a block of 4 x 4 columns and four layers [kg].
struct Masses {
  std::vector<double> of = std::vector<double>(4 * block_columns);
  double mass(int n) const { return of[static_cast<std::size_t>(n)]; }
};

/// A contact point a quarter of a cell behind node (1, 1, 1), on a Cartesian grid with nodes of 1 kg from i = 2 on.
struct OnePoint {
  int cell[3] = {1, 1, 1}, body = 0;
  double offset[3] = {0.25, 0, 0}, inverse_mass = 0, friction = 0.3, area = 1;
  Vec3<double> normal{1, 0, 0};
  BlockSlot slot{0, 0, 4};
  GridView<double> grid;
  Masses nodes;

  OnePoint() {
    grid.columns = grid.rows = 4;
    grid.block_columns_x = 1;
    grid.spacing = grid.layer_height = 2;
    grid.mapping = Mapping::cartesian;
    grid.slots = &slot;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 2; i < 4; ++i) nodes.of[static_cast<std::size_t>(GridView<double>::node(slot, i, j, k))] = 1;
      }
    }
  }
  View view() {
    View v{};
    for (int a = 0; a < 3; ++a) {
      v.places.cell[a] = &cell[a];
      v.places.offset[a] = &offset[a];
    }
    v.normal = &normal;
    v.area = &area;
    v.body = &body;
    v.body_friction = &friction;
    v.inverse_mass = &inverse_mass;
    return v;
  }
};

TEST(ContactView, counts_the_mass_on_the_side_that_the_surface_looks_to) {
  OnePoint p;
  EXPECT_DOUBLE_EQ(p.view().mass_before<Linear>(p.grid, p.nodes, 0), 0.25);
  p.normal = {-1, 0, 0};
  EXPECT_EQ(p.view().mass_before<Linear>(p.grid, p.nodes, 0), 0) << "the mass is on the other side";
}

TEST(ContactView, shares_add_up_to_one_over_the_nodes_with_mass) {
  OnePoint p;
  p.inverse_mass = 1 / p.view().mass_before<Linear>(p.grid, p.nodes, 0);
  double sum = 0;
  p.view().around<Linear>(p.grid, p.nodes, 0, [&](int n, double share) {
    EXPECT_EQ(p.nodes.mass(n), 1);
    sum += share;
  });
  EXPECT_DOUBLE_EQ(sum, 1);
}

TEST(ContactView, an_obstacle_resists_with_its_own_friction) {
  OnePoint p;
  EXPECT_EQ(p.view().friction(0), 0.3);
}

TEST(ContactView, the_bed_is_covered_as_far_as_the_mass_makes_up_half_a_layer) {
  OnePoint p;
  p.inverse_mass = 1.0 / 3;
  EXPECT_DOUBLE_EQ(p.view().filled(p.grid, 0, 3), 0.5);  // 3 kg of 0.5 * 3 kg/m2 * 4 m2
  EXPECT_EQ(p.view().filled(p.grid, 0, 1), 1);
}

}  // namespace
}  // namespace talus::solver::testing
