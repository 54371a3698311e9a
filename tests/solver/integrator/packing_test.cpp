// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums and maps of the points: energies, thickness, packing; speed and pressure that no column exceeds.
#include "solver/integrator/particle_measures.hpp"

#include <numeric>

#include "solver/integrator/point_sums.hpp"
#include "tests/solver/scenes.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

class PackedPoints : public InEachPlace {
 protected:
  static Packing packing(const Domain& domain, ShapeKind shape, Mapping mapping = Mapping::terrain_following) {
    SolveOptions o;
    o.shape = shape;
    o.mapping = mapping;
    const auto solver = make_solver(make_scene(domain, o), o, GetParam());
    return solver->packing();
  }
};

constexpr ShapeKind all_shapes[] = {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp};

TEST_P(PackedPoints, on_a_lattice_fill_their_room) {
  Domain d = ground(24, 24, 1.0, 0.5, [](double x, double y) { return 0.2 * x - 0.1 * y; });
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  for (const ShapeKind shape : all_shapes) {
    SCOPED_TRACE(name_of(shape));
    const Packing found = packing(d, shape);
    // Two points a cell lie a quarter of a cell to either side of a node, one in the half cell on the bed. Volumes are
    // whole parts of 2^-24 of a cell.
    EXPECT_NEAR(found.largest, 1, 1e-6);
    EXPECT_NEAR(found.p99, 1, 1e-6);
    EXPECT_LE(found.p99, found.largest);
  }
}

TEST_P(PackedPoints, twice_in_the_room_of_one_are_packed_twice) {
  Domain d = filled(ground(24, 24, 1.0, 0.5, flat), {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing once = packing(d, ShapeKind::quadratic);
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing twice = packing(d, ShapeKind::quadratic);
  EXPECT_NEAR(twice.largest, 2 * once.largest, 1e-6);
  EXPECT_NEAR(twice.p99, 2 * once.p99, 0.02) << "within two bins";
}

TEST_P(PackedPoints, far_denser_in_a_few_nodes_do_not_show_in_the_percentile) {
  Domain d = filled(ground(64, 24, 1.0, 0.5, flat), {6, 56, 6, 18, 0, 3}, 2, 2);
  fill(d, {30, 31, 11, 12, 1, 1.5}, 2, 2);  // a cell of 3600, about cells that hold no hundredth
  const Packing found = packing(d, ShapeKind::quadratic);
  EXPECT_GT(found.largest, 1.2);
  EXPECT_LT(found.p99, 1.05);
}

TEST_P(PackedPoints, are_measured_alike_on_a_cartesian_grid) {
  Domain d = filled(ground(24, 24, 1.0, 0.5, flat), {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing follows = packing(d, ShapeKind::quadratic),
                level = packing(d, ShapeKind::quadratic, Mapping::cartesian);
  EXPECT_NEAR(level.largest, follows.largest, 1e-6);
}
TALUS_IN_EACH_PLACE(PackedPoints);

TEST(Packing, of_a_point_gives_all_of_its_volume_to_cells_and_bins) {
  const SmallGrid grid;
  for (OnePoint& point : some_points()) {
    std::vector<CellParts> parts(SmallGrid::nodes), bins(packing_bins);
    std::uint32_t most = 0;
    ScatterParts<double>{grid.view(), point.view(), parts.data()}(0);
    const double cell = 2 * 2 * 0.5;
    const auto expected = static_cast<double>(point.volume / cell * parts_of_cell);
    const auto held = static_cast<double>(std::accumulate(parts.begin(), parts.end(), CellParts{}));
    EXPECT_NEAR(held, expected, 0.5);
    const BinPacking<double> kernel{grid.view(), grid.active.data(), parts.data(), bins.data(), &most};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
    EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), CellParts{}),
              std::accumulate(parts.begin(), parts.end(), CellParts{}));
  }
}

TEST(Packing, percentile_leaves_a_hundredth_of_the_volume_above) {
  std::vector<CellParts> bins(packing_bins);
  bins[100] = 9900;
  bins[250] = 100;
  EXPECT_DOUBLE_EQ(packing_of(bins, 2.505).p99, 1.01);
  bins[250] = 102;
  EXPECT_DOUBLE_EQ(packing_of(bins, 2.505).p99, 2.505) << "the upper end of its bin, no more than the largest";
  EXPECT_EQ(packing_of(std::vector<CellParts>(packing_bins), 0).p99, 0);
}

template <class Shape>
class PointSums : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(PointSums, Shapes);

TYPED_TEST(PointSums, have_the_energies_and_momentum_of_the_point) {
  const SmallGrid grid(0.3, -0.2);
  Materials<double> materials;
  MaterialOptions options;
  options.density = 1500;
  materials.list[0] = make_material<double>(options);
  for (OnePoint& point : some_points()) {
    point.velocity[0] = 3;
    point.velocity[2] = -4;
    const MeasureEnergies<double, TypeParam> measure{grid.view(), point.view(), materials, {1, 2, -10}, false};
    const auto sums = measure(0);
    const double mass = 0.25 * 1500;
    const Vec3<double> at = point.place(grid);
    const double expected[] = {0.5 * mass * 25, -mass * (at.x + 2 * at.y - 10 * at.z), 0, 0.25, mass * 3, 0, mass * -4};
    for (int row = 0; row < 7; ++row)  // rounding of a dozen operations on numbers up to 1e5
      EXPECT_NEAR(sums.value[row], expected[row], 1e-10 * mass) << "sum " << row;
  }
}

TYPED_TEST(PointSums, spread_all_of_a_volume_about_the_point) {
  for (OnePoint& point : some_points()) {
    std::vector<double> volume(64);
    ScatterThickness<double, TypeParam>{point.view(), SmallGrid::side, volume.data()}(0);
    const double sum = std::accumulate(volume.begin(), volume.end(), 0.0);
    EXPECT_NEAR(sum, point.volume, 1e-15);
    double x = 0;
    for (std::size_t n = 0; n < volume.size(); ++n) x += volume[n] / sum * static_cast<double>(n % SmallGrid::side);
    EXPECT_NEAR(x, point.cell[0] + point.offset[0], 1e-14) << "its centre is that of the point";
    point.cell[0] = -1;
    const std::vector<double> before = volume;
    ScatterThickness<double, TypeParam>{point.view(), SmallGrid::side, volume.data()}(0);
    EXPECT_EQ(volume, before) << "a point that has left has no thickness";
  }
}

/// The maps of a small grid, from points that go their ways.
struct MovingPoints {
  SmallGrid grid;
  Clock clock;
  Materials<double> materials;
  std::vector<Vec4<double>> motion = std::vector<Vec4<double>>(64);
  std::vector<double> thickness = std::vector<double>(64), speed = thickness, pressure = thickness,
                      arrival = std::vector<double>(64, -1);

  MovingPoints() {
    MaterialOptions options;
    options.density = 2000;
    materials.list[0] = make_material<double>(options);
    clock.motion_maps.is_due = 1;
  }
  MapView maps(double threshold) {
    return {{thickness.data(), speed.data(), pressure.data(), arrival.data()}, threshold};
  }
  template <class Shape>
  void record(std::vector<OnePoint>& points, double threshold = 0) {
    for (OnePoint& p : points) ScatterMotion<double, Shape>{grid.view(), p.view(), materials, &clock, motion.data()}(0);
    const RecordMotion<double> kernel{grid.view(), grid.active.data(), {2000, nullptr}, motion.data(), maps(threshold)};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

std::vector<OnePoint> two_points() {
  std::vector<OnePoint> points(2);
  points[0].velocity[0] = 30;
  points[1].velocity[1] = -40;
  points[1].volume = 0.75;
  return points;
}

template <class Shape>
class MotionOfPoints : public ::testing::Test {};
using MotionShapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(MotionOfPoints, MotionShapes);

TYPED_TEST(MotionOfPoints, is_the_mean_over_mass_of_those_about_the_column) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<TypeParam>(points);
  const double mean = std::hypot(30 * 0.25, 40 * 0.75);
  EXPECT_NEAR(moving.speed[4 * SmallGrid::side + 3], mean, 1e-13 * mean);
  EXPECT_NEAR(moving.pressure[4 * SmallGrid::side + 3], 2000 * mean * mean, 1e-9 * mean);
  EXPECT_EQ(moving.speed[0], 0);
}

TYPED_TEST(MotionOfPoints, never_exceeds_that_of_the_fastest_in_columns_of_any_mass) {
  MovingPoints moving;
  for (int n = 0; n <= 20; ++n) {
    auto points = two_points();
    points[0].offset[0] = -0.5 + 0.05 * n;  // its share of the columns beside it goes down to nothing
    points[1].offset[1] = 0.4999 - 0.05 * n;
    moving.record<TypeParam>(points);
  }
  // A mean of two numbers is exact to a few roundings.
  for (const double v : moving.speed) EXPECT_LE(v, 40 * (1 + 1e-14));
  for (const double p : moving.pressure) EXPECT_LE(p, 2000 * 40 * 40 * (1 + 1e-14));
}

TEST(MotionMaps, leave_no_sums_behind) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<Quadratic>(points);
  for (const Vec4<double>& sum : moving.motion) EXPECT_EQ(sum.w + sum.x + sum.y + sum.z, 0);
}

TEST(MotionMaps, record_when_the_clock_says_so) {
  MovingPoints moving;
  moving.clock.motion_maps.is_due = 0;
  auto points = two_points();
  moving.record<Quadratic>(points);
  EXPECT_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 0);
}

TEST(MotionMaps, count_from_the_threshold_on) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<Quadratic>(points, 1);  // of 1 m3 on cells of 4 m2
  EXPECT_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 0);
}

TEST(MotionMaps, forget_points_that_have_left) {
  MovingPoints moving;
  auto points = two_points();
  points[1].cell[0] = -1;
  moving.record<Quadratic>(points);
  EXPECT_DOUBLE_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 30);
}

}  // namespace
}  // namespace talus::solver::testing
