// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Drag and cohesion of the bed, which act on columns.
#include "solver/boundary/column_traction.hpp"

#include <gtest/gtest.h>

#include "solver/boundary/contact_impulses.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

TEST(ShareLeftByTraction, is_what_an_implicit_step_of_drag_leaves) {
  // v' = v - dt drag v'/v / m for a drag that is taken as proportional to the new speed
  constexpr double speed = 5, drag = 300, rate = 0.01;
  const double left = share_left_by_traction(speed, drag, 0.0, rate);
  EXPECT_DOUBLE_EQ(left * speed, speed - rate * drag * left);
}

TEST(ShareLeftByTraction, stops_what_cohesion_can_hold_and_turns_nothing_back) {
  EXPECT_EQ(share_left_by_traction(2.0, 0.0, 300.0, 0.01), 0);
  EXPECT_DOUBLE_EQ(share_left_by_traction(4.0, 0.0, 300.0, 0.01), 0.25);
  EXPECT_GT(share_left_by_traction(4.0, 1e9, 0.0, 0.01), 0) << "however light the column is";
  EXPECT_EQ(share_left_by_traction(0.0, 300.0, 300.0, 0.01), 1);
}

/// A sheet of two layers of nodes over the columns from 2 to 5 both ways, 100 kg a node at (3, 1) m/s along the ground.
struct Sheet {
  SmallGrid grid{0.3, -0.2};
  Clock clock;
  std::vector<Vec4<double>> nodes = std::vector<Vec4<double>>(SmallGrid::nodes), changes = nodes;
  std::vector<double> mass = std::vector<double>(64);
  std::vector<double> rise = std::vector<double>(64, off_bed);
  std::vector<double> volumes;  ///< of the columns [m3]; empty where all have 2000 kg/m3
  BaseFriction<double> friction{FrictionLaw::voellmy, {{0.5, 3}, 0}};  // 3 Pa s2/m2

  Sheet() {
    clock.step_size = 0.1;
    for (int j = 2; j < 6; ++j) {
      for (int i = 2; i < 6; ++i) {
        for (int k = 0; k < 2; ++k) put(i, j, k);
        mass[column(i, j)] = 200;
        rise[column(i, j)] = -1;
      }
    }
  }
  static std::size_t column(int i, int j) { return static_cast<std::size_t>(j * SmallGrid::side + i); }
  Vec4<double>& at(int i, int j, int k) { return nodes[static_cast<std::size_t>(grid.view().find(i, j, k))]; }
  void put(int i, int j, int k) { at(i, j, k) = {100, 3, 1, 3 * 0.3 - 1 * 0.2}; }
  void slow(bool with_yield = true) {
    for_each_column_twice<block_columns>(
        CpuDevice::make(), 4,
        SlowColumns<double, PackedNodes<double>>{.grid = grid.view(),
                                                 .active = grid.active.data(),
                                                 .nodes = {nodes.data(), changes.data()},
                                                 .friction = friction,
                                                 .columns = {mass.data(), rise.data()},
                                                 .step = {&clock, 0, {{0, 0, -9.81}}},
                                                 .with_yield = with_yield,
                                                 .density = {2000, volumes.empty() ? nullptr : volumes.data()},
                                                 .submersion = {}});
  }
};

constexpr double area = 4 * 1.0630145812734649;  // 2 m by 2 m on slopes of 0.3 and -0.2

TEST(SlowColumns, gives_all_nodes_of_a_column_the_drag_of_its_whole_bed) {
  Sheet s;
  const Vec4<double> before = s.at(3, 3, 1);
  const double speed = length(Vec3<double>{before.x, before.y, before.z});
  s.slow();
  const double left = share_left_by_traction(speed, 3 * speed * speed, 0.0, area * 0.1 / 200);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(s.at(3, 3, k).x, left * before.x, 1e-13);
    EXPECT_NEAR(s.at(3, 3, k).y, left * before.y, 1e-13);
    EXPECT_NEAR(s.at(3, 3, k).z, left * before.z, 1e-13) << "along the ground";
    const std::size_t n = static_cast<std::size_t>(s.grid.view().find(3, 3, k));
    EXPECT_NEAR(s.changes[n].x, (left - 1) * before.x, 1e-13);
  }
}

TEST(SlowColumns, leaves_alone_what_flies) {
  Sheet s;
  s.put(3, 3, 5);  // over the sheet, with empty nodes between
  s.rise[Sheet::column(4, 3)] = off_bed;
  s.slow();
  EXPECT_LT(s.at(3, 3, 1).x, 3);
  EXPECT_EQ(s.at(3, 3, 5).x, 3);
  EXPECT_EQ(s.at(4, 3, 0).x, 3) << "a column that does not press";
}

TEST(SlowColumns, drags_what_hops_by_less_than_half_its_depth) {
  // The speed at which the sheet would rise by half its depth, along the normal of the ground.
  const double depth = 200 / area / 2000, press = 9.81 / 1.0630145812734649, speed = std::sqrt(press * depth);
  for (const double rise : {-1.0, 0.0, 0.99 * speed, 1.01 * speed}) {
    for (const double duration : {0.1, 1e-4}) {
      Sheet s;
      s.clock.step_size = duration;
      s.rise[Sheet::column(3, 3)] = rise;
      s.slow();
      EXPECT_EQ(s.at(3, 3, 0).x < 3, rise < speed) << rise << " m/s, a step of " << duration << " s";
    }
  }
}

TEST(SlowColumns, tell_the_depth_of_lighter_matter_by_its_volume) {
  const double press = 9.81 / 1.0630145812734649, speed = std::sqrt(press * 200 / area / 2000);
  for (const double lighter : {1.0, 2.0}) {
    Sheet s;
    s.volumes.assign(64, lighter * 200 / 2000);
    s.rise[Sheet::column(3, 3)] = 1.2 * speed;
    s.slow();
    EXPECT_EQ(s.at(3, 3, 0).x<3, lighter> 1) << "it hops by less than half of twice the depth";
  }
}

TEST(SlowColumns, takes_cohesion_where_asked) {
  Sheet s;
  s.friction.uniform.cohesion = 1e6;
  s.slow(false);
  EXPECT_GT(s.at(3, 3, 0).x, 1);
  s.slow(true);
  EXPECT_EQ(s.at(3, 3, 0).x, 0);
}

TEST(SlowColumns, counts_what_the_bed_takes) {
  Sheet s;
  s.clock.budget.is_kept = 1;
  double before = 0, after = 0;
  const auto energy = [&] {
    double sum = 0;
    for (const auto& n : s.nodes) sum += 0.5 * n.w * (n.x * n.x + n.y * n.y + n.z * n.z);
    return sum;
  };
  before = energy();
  s.slow();
  after = energy();
  EXPECT_NEAR(s.clock.budget.bed_loss, before - after, 1e-9);
  EXPECT_NEAR(s.clock.budget.drag_loss, before - after, 1e-9);
  EXPECT_NEAR(s.clock.budget.transfer_loss, after - before, 1e-9);
  EXPECT_LT(s.clock.budget.reaction[0], 0);
}

/// Grains over a rough bed: mu between 0.4 and 0.6, over 0.02 m, in a mass of 2000 kg/m3.
BaseFriction<double> grains() {
  return {.law = FrictionLaw::pouliquen, .uniform = {{0.4, 0.2, 0.42, 0.02}, 0}, .constants = {0.136, 0, 2000}};
}

TEST(MeasureCoefficients, gives_columns_the_friction_of_their_depth_and_mean_speed) {
  Sheet s;
  const BaseFriction<double> law = grains();
  s.at(3, 3, 1).x = 5;  // the mean of 3 and 5 m/s
  s.at(3, 3, 1).w = s.at(3, 3, 0).w;
  s.at(3, 3, 1).z = 5 * 0.3 - 1 * 0.2;
  std::vector<double> coefficient(64, -1);
  for_each(CpuDevice::make(), 4 * block_columns,
           MeasureCoefficients<double, PackedNodes<double>>{.grid = s.grid.view(),
                                                            .active = s.grid.active.data(),
                                                            .nodes = {s.nodes.data(), nullptr},
                                                            .friction = law,
                                                            .mass = s.mass.data(),
                                                            .coefficient = coefficient.data(),
                                                            .step = {&s.clock, 0, {{0, 0, -9.81}}}});
  const double load = 200 / area, speed = length(Vec3<double>{4, 1, 4 * 0.3 - 1 * 0.2});
  const Slip<double> slip{speed, load * 9.81 * 4 / area, 0.1, load};
  EXPECT_NEAR(coefficient[Sheet::column(3, 3)], law.coefficient(law.uniform, slip), 1e-14);
  EXPECT_GT(coefficient[Sheet::column(3, 3)], coefficient[Sheet::column(4, 3)]) << "the slower one";
  EXPECT_EQ(coefficient[Sheet::column(7, 7)], -1) << "no mass";
}

TEST(ColumnTraction, stores_nothing_that_the_law_does_not_ask_for) {
  const BaseFriction<double> coulomb{FrictionLaw::coulomb, {{0.5}, 0}};
  ColumnTraction<double, CpuDevice> none(CpuDevice::make(), coulomb, 8, 8);
  EXPECT_EQ(none.bytes(), 0u);
  EXPECT_FALSE(none.acts() || none.measures());
  EXPECT_EQ(none.seen_by(coulomb).measured, nullptr);
  const BaseFriction<double> voellmy{FrictionLaw::voellmy, {{0.5, 3}, 0}};
  ColumnTraction<double, CpuDevice> drag(CpuDevice::make(), voellmy, 8, 8);
  EXPECT_EQ(drag.bytes(), 64 * 2 * sizeof(double));
  EXPECT_TRUE(drag.acts() && !drag.measures());
  ColumnTraction<double, CpuDevice> friction(CpuDevice::make(), grains(), 8, 8);
  EXPECT_TRUE(friction.measures() && !friction.acts());
  EXPECT_EQ(friction.slowed().mass, nullptr);
  EXPECT_EQ(friction.seen_by(grains()).measured, friction.coefficients());
}

TEST(Cover, is_whole_inside_and_the_share_of_the_mass_at_the_edge) {
  Sheet s;
  EXPECT_EQ(cover(s.grid.view(), s.mass.data(), 3, 3), 1);
  EXPECT_EQ(cover(s.grid.view(), s.mass.data(), 2, 3), 1) << "an edge as thick as the inside";
  s.mass[Sheet::column(1, 3)] = 50;  // a quarter of what lies further in
  EXPECT_DOUBLE_EQ(cover(s.grid.view(), s.mass.data(), 1, 3), 0.25);
  for (double& mass : s.mass) mass = 200;
  s.mass[Sheet::column(3, 3)] = 50;
  EXPECT_EQ(cover(s.grid.view(), s.mass.data(), 3, 3), 1) << "a thin place inside";
}

/// The masses of the nodes over a line, of matter from x = 0 to `length` spacings that is `depth`(x) deep.
template <class Depth>
std::vector<double> masses_over_line(double first_node, double length, Depth depth) {
  std::vector<double> masses(8);
  constexpr int parts = 8000;
  for (int p = 0; p < parts; ++p) {
    const double x = length * (p + 0.5) / parts;
    for (int n = 0; n < 8; ++n) {
      const double r = std::abs(x - (first_node + n));
      masses[static_cast<std::size_t>(n)] += (r < 0.5   ? 0.75 - r * r
                                              : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r)
                                                        : 0) *
                                             depth(x) * length / parts;
    }
  }
  return masses;
}

/// How much of the line the columns of its first nodes cover together, in spacings.
double covered_length(const std::vector<double>& line, int nodes) {
  const SmallGrid grid;
  std::vector<double> mass(64);
  for (std::size_t j = 0; j < 8; ++j)
    for (std::size_t i = 0; i < 8; ++i) mass[j * 8 + i] = line[i];
  double sum = 0;
  for (int i = 0; i < nodes; ++i) sum += cover(grid.view(), mass.data(), i, 4);
  return sum;
}

TEST(Cover, adds_up_to_the_length_of_a_wall_wherever_it_lies_in_the_grid) {
  for (const double first_node : {-2.0, -1.5, -1.75}) {
    const auto line = masses_over_line(first_node, 4, [](double) { return 1.0; });
    EXPECT_NEAR(covered_length(line, 8), 4, 0.14) << "first node at " << first_node;  // 0.07 cells at each end
  }
}

/// The mass of a rim that thins out falls with its depth as well: by its share of what lies further in, 0.4 to 0.8 of a
/// spacing of each rim would lie on nothing. What is left is a quarter of a spacing at most.
TEST(Cover, adds_up_to_the_length_of_a_wedge_wherever_its_tip_lies_in_the_grid) {
  for (const double first_node : {-2.0, -1.75, -1.5, -1.25}) {
    const auto line = masses_over_line(first_node, 8, [](double x) { return x; });
    EXPECT_NEAR(covered_length(line, 5), first_node + 4.5, 0.25) << "first node at " << first_node;
  }
}

/// Even matter between walls on nodes: those on a wall hold half a cell of it, and cover half a cell.
TEST(Cover, is_half_a_cell_of_each_column_on_a_wall_however_narrow_the_strip) {
  const SmallGrid grid;
  for (int wide = 1; wide <= 5; ++wide) {
    GridView<double> view = grid.view();
    view.walls.x = {1, 1.0 + wide};
    std::vector<double> mass(64);
    for (std::size_t n = 0; n < 64; ++n) {
      const int i = static_cast<int>(n % 8);
      mass[n] = i < 1 || i > 1 + wide ? 0 : i == 1 || i == 1 + wide ? 50 : 100;
    }
    double covered = 0;
    for (int i = 1; i <= 1 + wide; ++i) covered += bed_under(view, mass.data(), i, 4).area;
    EXPECT_DOUBLE_EQ(covered, wide * grid.spacing * grid.spacing) << wide << " cells wide";
  }
}

/// Even matter between walls anywhere: each column's share of the bed is that of the matter which its node holds, and
/// at least a hundredth.
TEST(Cover, is_the_width_of_a_strip_wherever_its_walls_stand) {
  const SmallGrid grid;
  for (const double wide : {0.75, 1.0, 2.0, 4.0}) {
    for (const double first : {1.25, 1.5, 1.75}) {
      GridView<double> view = grid.view();
      view.walls.x = {first, first + wide};
      const std::vector<double> line = masses_over_line(-first, wide, [](double) { return 1.0; });
      std::vector<double> mass(64);
      for (std::size_t n = 0; n < 64; ++n) mass[n] = line[n % 8];
      double covered = 0;
      for (int i = 0; i < 8; ++i) {
        if (line[static_cast<std::size_t>(i)] > 0) covered += bed_under(view, mass.data(), i, 4).area;
      }
      EXPECT_NEAR(covered / (wide * grid.spacing * grid.spacing), 1, 0.02 / wide) << wide << " wide from " << first;
    }
  }
}

TEST(Cover, mirrors_nothing_in_walls_that_leave_no_room) {
  EXPECT_EQ(mirrored(-1, {1, 2}), 1) << "behind one, then the other";
  EXPECT_EQ(mirrored(4, {1, 3}), 2);
  EXPECT_EQ(mirrored(4, {2, 2}), 2);
  EXPECT_EQ(mirrored(4, {5, 3}), 4);
}

TEST(Cover, mirrors_columns_in_walls_between_nodes) {
  EXPECT_EQ(mirrored(2, {2.25, 9}), 3);
  EXPECT_EQ(mirrored(1, {2.75, 9}), 5);
  EXPECT_EQ(mirrored(7, {0, 5.5}), 4);
}

}  // namespace
}  // namespace talus::solver::testing
