// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of basal laws; the bed at base nodes and columns: impulses, how far the ground turns, what is held.
#include "solver/boundary/base_friction.hpp"
#include "common/domain/bed_numbers.hpp"
#include "solver/boundary/bed_hold.hpp"
#include "solver/boundary/contact_impulses.hpp"
#include "solver/boundary/law.hpp"
#include "solver/options/bed.hpp"
#include "tests/solver/boundary/any_law.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::testing {
namespace {

using solver::BaseOptions;

TEST(FrictionLaws, hold_what_every_law_must) { expect_laws_to_hold<FrictionLaws>(); }

TEST(FrictionLaws, weaken_or_drag_as_their_numbers_say) {
  OptionsOfLaws<FrictionLaws> o;
  o.turbulence = 1000;
  const auto voellmy = some_bed<Voellmy, FrictionLaws>(o);
  EXPECT_DOUBLE_EQ(voellmy.coefficient(voellmy.uniform, {5, 0, 0.01}), std::tan(20 * std::numbers::pi / 180));
  EXPECT_DOUBLE_EQ(voellmy.drag(voellmy.uniform, {5, 0, 0.01}), 2000 * 9.81 / 1000 * 25);
  const auto weakening = some_bed<VelocityWeakening, FrictionLaws>(o);
  EXPECT_DOUBLE_EQ(weakening.coefficient(weakening.uniform, {1, 0, 0.01}), (0.7 + 0.23) / 2);
}

TEST(Bed, is_no_larger_than_its_five_numbers_were) { EXPECT_LE(sizeof(Bed<double>), 5 * sizeof(double)); }

TEST(BedNumbers, are_those_of_the_laws_and_have_a_member_each) {
  BaseOptions options;
  std::set<double*> members;
  for (const std::string_view key : bed_numbers) {
    double* const number = options.named(key);
    ASSERT_NE(number, nullptr) << key;
    EXPECT_TRUE(members.insert(number).second) << key;
    bool used = false;
    FrictionLaws::each([&](auto law) {
      options.law = static_cast<FrictionLaw>(FrictionLaws::index_of<decltype(law)>());
      used = used || options.uses(key);
    });
    EXPECT_TRUE(used) << key << " belongs to no law";
  }
  EXPECT_EQ(options.named("law"), nullptr);
}

/// The numbers of a law, those of a place and of the scene.
template <class Law>
struct Made {
  std::vector<double> here = std::vector<double>(Law::count), everywhere = std::vector<double>(Law::constant_count);
  explicit Made(const BaseOptions& o) {
    const BedSetting setting{.borne = 1, .density = 2000, .gravity = 9.81};
    Law::numbers(o, setting, here.data());
    Law::constants(o, setting, everywhere.data());
  }
};

TEST(BedNumbers, reach_the_numbers_of_a_place_and_no_others_do) {
  // A number of the scene that a raster gives would be missed in silence, and so would one of a place that none gives.
  FrictionLaws::each([&](auto law) {
    using Law = decltype(law);
    typename Law::Options own;
    recipe::Defaults keys;
    own.describe(*recipe::make_collector("law", keys), {});
    for (const auto& [place, value] : keys) {
      const std::string key = place.substr(place.rfind('.') + 1);
      const bool from_raster = std::find(bed_numbers.begin(), bed_numbers.end(), key) != bed_numbers.end();
      BaseOptions options;
      const Made<Law> before(options);
      if constexpr (std::is_same_v<Law, FrictionTable>) {
        options.table.back()[0] *= 0.9;
      } else {
        double* const number = options.named(key);
        ASSERT_NE(number, nullptr) << key;
        *number = 0.9 * *number + 0.01;
      }
      const Made<Law> after(options);
      EXPECT_EQ(before.here != after.here, from_raster) << key;
      EXPECT_EQ(before.everywhere != after.everywhere, !from_raster) << key;
    }
  });
}

TEST(BaseOptions, say_the_bed_in_a_line) {
  BaseOptions o;
  o.cohesion = 50;
  EXPECT_EQ(o.words(), "coulomb, 20 deg, cohesion 50 Pa");
  o.law = FrictionLaw::voellmy;
  o.pore_pressure_ratio = 0.5;
  EXPECT_EQ(o.words(), "voellmy, 20 deg and xi = 500 m/s2, cohesion 50 Pa, water carries 0.5 of the normal stress");
  o.law = FrictionLaw::stick;
  EXPECT_EQ(o.words(), "held");
}

}  // namespace
}  // namespace talus::testing

namespace talus::solver::testing {
namespace {

BaseFriction<double> coulomb(double mu) { return {FrictionLaw::coulomb, {{mu}}}; }
Vec3<double> meet(const BaseFriction<double>& f, const Vec3<double>& v, double sx, double sy, double grip = 0) {
  return meet_ground(f, 0, v, sx, sy, {.duration = 0.01, .grip = grip});
}

TEST(MeetGround, lets_a_leaving_node_go) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{1, 0, 0.6}, 0.5, 0.0);
  EXPECT_EQ(v.x, 1);
  EXPECT_EQ(v.z, 0.6);
}

TEST(MeetGround, takes_the_normal_velocity_and_mu_times_it_along_the_slip) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{3, 0, -2}, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(v.z, 0);
  EXPECT_DOUBLE_EQ(v.x, 3 - 0.5 * 2);
}

TEST(MeetGround, sticks_when_friction_suffices) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{0.9, 0, -2}, 0.0, 0.0);
  EXPECT_EQ(v.x, 0);
  EXPECT_EQ(v.z, 0);
}

TEST(MeetGround, leaves_a_sloping_bed_tangentially) {
  const double sx = 0.4, sy = -0.3;
  const Vec3<double> v = meet(coulomb(0.1), Vec3<double>{2, 1, -3}, sx, sy);
  EXPECT_NEAR(v.z, sx * v.x + sy * v.y, 1e-14);
}

TEST(MeetGround, leaves_cohesion_and_drag_to_the_column) {
  const BaseFriction<double> f{FrictionLaw::voellmy, {{0.5, 3}, 10}};  // 3 Pa s2/m2, 10 Pa
  EXPECT_DOUBLE_EQ(meet(f, Vec3<double>{4, 0, -2}, 0.0, 0.0).x, 4 - 0.5 * 2);
  EXPECT_DOUBLE_EQ(f.drag(f.uniform, {4, 0, 0.01}), 3 * 16);
  EXPECT_TRUE(f.has_drag());
  EXPECT_TRUE(f.has_traction());
}

TEST(BaseFriction, weakens_from_peak_to_steady_state) {
  const BaseFriction<double> f{FrictionLaw::velocity_weakening, {{0.2, 0.7, 4}}};
  EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, {0, 0, 0.01}), 0.7);
  EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, {4, 0, 0.01}), 0.45);  // half the drop at the characteristic speed
  EXPECT_NEAR(f.coefficient(f.uniform, {1e9, 0, 0.01}), 0.2, 1e-8);
}

/// Ground z = a x^2 / 2 + c x y + e y^2 / 2, whose slopes change evenly.
struct CurvedGrid {
  static constexpr double a = 0.02, c = -0.01, e = 0.03;
  SmallGrid grid;

  CurvedGrid() {
    for (int j = 0; j < SmallGrid::side; ++j) {
      for (int i = 0; i < SmallGrid::side; ++i) {
        const double x = i * grid.spacing, y = j * grid.spacing;
        const auto n = static_cast<std::size_t>(j * SmallGrid::side + i);
        grid.slope_x[n] = a * x + c * y;
        grid.slope_y[n] = c * x + e * y;
      }
    }
  }
};

TEST(GroundTurn, is_the_climb_beyond_the_slopes_under_the_node) {
  const CurvedGrid ground;
  const Vec3<double> v{6, -4, 1};
  const double dt = 0.25, bend = ground.a * 36 - 2 * ground.c * 24 + ground.e * 16;
  for (const int i : {0, 3, 7})
    for (const int j : {0, 4, 7}) EXPECT_NEAR(climb_ahead(ground.grid.view(), i, j, v, dt), dt / 2 * bend, 1e-14);
  const double sx = ground.a * 6 + ground.c * 8, sy = ground.c * 6 + ground.e * 8;
  EXPECT_NEAR(turn_of_ground(ground.grid.view(), 3, 4, v, dt), dt / 2 * bend / std::sqrt(1 + sx * sx + sy * sy), 1e-14);
  const SmallGrid plane(0.5, -0.25);
  EXPECT_EQ(turn_of_ground(plane.view(), 3, 4, v, dt), 0);
}

TEST(GroundTurn, is_what_a_node_keeps_of_its_velocity_across_the_bed) {
  const Vec3<double> up{0, 0, 1};
  // A hollow that turns by 0.5 m/s: a node that slides level is pushed up, and friction takes its share of that.
  Vec3<double> v = meet_surface(Vec3<double>{10, 0, 0}, up, 0.4, 0.5);
  EXPECT_NEAR(v.z, 0.5, 1e-15);
  EXPECT_NEAR(v.x, 10 - 0.4 * 0.5, 1e-14);
  // A hump that falls away by 0.5 m/s: down to there the node is free, below it the ground holds.
  v = meet_surface(Vec3<double>{10, 0, -0.3}, up, 0.4, -0.5);
  EXPECT_EQ(v.z, -0.3);
  EXPECT_EQ(v.x, 10);
  v = meet_surface(Vec3<double>{10, 0, -0.7}, up, 0.4, -0.5);
  EXPECT_NEAR(v.z, -0.5, 1e-15);
  EXPECT_NEAR(v.x, 10 - 0.4 * 0.2, 1e-14);
}

/// A column of two nodes of 100 kg on a slope, normal (-0.6, 0, 0.8), that bends away to all sides, and one that flies
/// above them. Gravity is weak, the mass light: 80 m deep.
struct HeldColumn {
  SmallGrid grid{0.75, 0};
  Clock clock;
  std::vector<Vec4<double>> nodes = std::vector<Vec4<double>>(SmallGrid::nodes), changes = nodes;
  std::vector<double> rise = std::vector<double>(64, 1), pressed = std::vector<double>(64);
  Walls<double> walls;
  double pull = 0.1, density = 0.5;

  /// Speeds along the slope and away from it of the three [m/s].
  explicit HeldColumn(double along, double base, double above, double bend = 0.02) {
    clock.budget.is_kept = 1;
    clock.step_size = 0.1;
    for (int n = 0; n < SmallGrid::side * SmallGrid::side; ++n) {
      grid.slope_x[static_cast<std::size_t>(n)] -= bend * grid.spacing * (n % SmallGrid::side - 5);
      grid.slope_y[static_cast<std::size_t>(n)] -= bend * grid.spacing * (n / SmallGrid::side - 2);
    }
    put(0, along, base);
    put(1, along, above);
    put(4, along, 3);
  }
  Vec4<double>& at(int k) { return nodes[static_cast<std::size_t>(grid.view().find(5, 2, k))]; }
  void put(int k, double along, double away) { at(k) = {100, 0.8 * along - 0.6 * away, 0, 0.6 * along + 0.8 * away}; }
  double away(int k) { return -0.6 * at(k).x + 0.8 * at(k).z; }
  double along(int k) { return 0.8 * at(k).x + 0.6 * at(k).z; }
  /// Holds the column, and returns the speed by which the ground turns away below it [m/s].
  double hold() {
    const Vec3<double> mean{(at(0).x + at(1).x) / 2, (at(0).y + at(1).y) / 2, (at(0).z + at(1).z) / 2};
    for_each(CpuDevice::make(), 4 * block_columns,
             HoldColumns<double, PackedNodes<double>>{.grid = grid.view(),
                                                      .active = grid.active.data(),
                                                      .nodes = {nodes.data(), changes.data()},
                                                      .step = {&clock, 0, {{0, 0, -pull}}},
                                                      .walls = walls,
                                                      .density = density,
                                                      .rise = rise.data()});
    return turn_of_ground(grid.view(), 5, 2, mean, clock.step_size);
  }
};

TEST(HoldColumns, takes_what_the_column_leaves_by_as_a_whole) {
  HeldColumn c(5, 2, 2);
  const double turn = c.hold(), taken = 2 - turn;
  EXPECT_LT(turn, -0.005);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(c.away(k), turn, 1e-14);
    EXPECT_NEAR(c.along(k), 5, 1e-14) << "a pull gives no friction";
  }
  EXPECT_NEAR(c.away(4), 3, 1e-14) << "what flies above is left alone";
  EXPECT_EQ(c.rise[SmallGrid::column], 0) << "it lies on the bed";
  EXPECT_NEAR(c.clock.budget.holding_loss, 0.5 * 200 * (2 * 2 - turn * turn), 1e-10);
  EXPECT_NEAR(c.clock.budget.bed_loss + c.clock.budget.transfer_loss, 0, 1e-10);
  EXPECT_NEAR(c.clock.budget.reaction[0], 200 * taken * 0.6, 1e-10);
  EXPECT_NEAR(c.clock.budget.reaction[2], -200 * taken * 0.8, 1e-10);
  EXPECT_NEAR(c.changes[static_cast<std::size_t>(c.grid.view().find(5, 2, 1))].z, -taken * 0.8, 1e-14);
}

TEST(HoldColumns, takes_no_more_than_base_node_and_column_have) {
  HeldColumn thickens(5, 0.5, 3);  // the mean rises faster than the base: it gets thicker
  double turn = thickens.hold();
  EXPECT_NEAR(thickens.away(0), turn, 1e-14);
  EXPECT_NEAR(thickens.away(1), 2.5 + turn, 1e-14);
  HeldColumn sinks(5, 0.5, -3);  // the base springs back under what comes down: that is not pushed
  turn = sinks.hold();
  EXPECT_NEAR(sinks.away(0), turn, 1e-14);
  EXPECT_NEAR(sinks.away(1), -3, 1e-14);
}

TEST(HoldColumns, leaves_alone_what_presses_what_flies_high_and_what_no_bend_throws) {
  HeldColumn presses(5, -1, 2), level(5, 2, 2, 0), heavy(5, 2, 2), shallow(5, 2, 2);
  heavy.pull = 1;         // its weight bends its way faster than the ground bends
  shallow.density = 0.9;  // 44 m deep: over a plane it would fly 25 m high
  for (HeldColumn* c : {&presses, &level, &heavy, &shallow}) {
    const auto before = c->nodes;
    c->hold();
    for (std::size_t n = 0; n < before.size(); ++n) EXPECT_EQ(c->nodes[n].z, before[n].z);
    EXPECT_EQ(c->clock.budget.holding_loss, 0);
  }
}

TEST(HoldColumns, stays_before_a_wall_that_the_nodes_have_met) {
  HeldColumn c(0, 2, 2);
  c.walls.count = 1;
  c.walls.list[0] = {.axis = 0, .side = -1, .position = 5, .kind = WallKind::roller};  // holds columns from 5 on
  c.at(0) = c.at(1) = {100, 0, 3, 2};
  c.hold();
  EXPECT_LT(c.at(1).z, 1.5) << "it was held";
  EXPECT_EQ(c.at(1).x, 0);
}

TEST(Hops, are_low_up_to_half_the_depth_over_even_ground_and_over_what_falls_away) {
  const Vec3<double> g{0, 0, -10};
  const SmallGrid plane(0.75, 0);
  const Vec3<double> v{0.8 - 0.6, 0, 0.6 + 0.8};  // 1 m/s along the plane and off it, which it is by 1 / 16 m at most
  EXPECT_TRUE(hops_low(plane.view(), 5, 2, v, g, 1.01 / 8));
  EXPECT_FALSE(hops_low(plane.view(), 5, 2, v, g, 0.99 / 8));
  SmallGrid edge;  // level ground that falls by 2 m from x = 6 to 10 m: at 10 m/s a body is 1.2 m above its foot
  for (std::size_t n = 0; n < edge.slope_x.size(); ++n) edge.slope_x[n] = n % 8 == 4 ? -1 : 0;
  const Vec3<double> level{10, 0, 1e-3};
  EXPECT_TRUE(hops_low(edge.view(), 3, 3, level, g, 3.0));
  EXPECT_FALSE(hops_low(edge.view(), 3, 3, level, g, 2.0));
}

TEST(CountLanding, counts_what_bed_and_weight_took_of_the_motion_across_the_bed) {
  for (const double impulse : {0.0, 160.0, 400.0, 2000.0}) {
    HeldColumn c(5, -1, -1);
    c.pressed[SmallGrid::column] = impulse;
    for_each(CpuDevice::make(), 4 * block_columns,
             CountLanding<double, PackedNodes<double>>{.grid = c.grid.view(),
                                                       .active = c.grid.active.data(),
                                                       .nodes = {c.nodes.data(), nullptr},
                                                       .pressed = c.pressed.data(),
                                                       .step = {&c.clock, 0, {{0, 0, -10}}}});
    const double taken = impulse - 200 * 10 * 0.8 * 0.1;  // beyond the weight of what lies on the bed
    const double was = 1 + taken / 200;                   // towards the bed, before
    EXPECT_NEAR(c.clock.budget.landing_loss, 0.5 * 200 * (was * was - 1), 1e-10) << impulse;
  }
}

}  // namespace
}  // namespace talus::solver::testing
