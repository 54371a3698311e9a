// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/particles/seed.hpp"

#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

Release random_release(const MapGrid& grid, std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  Raster thickness = test::raster_of(grid, [&](double, double) {
    const double t = part(random);
    return t < 0.3 ? 0.0 : 80 * t * t * t * t;  // from millimetres to tens of metres
  });
  return {"A", std::move(thickness)};
}

double volume_of_points(const SeedPoints& points) {
  Sum sum;
  for (double v : points.volume) sum.add(v);
  return sum.value();
}

Seeding seeding(int x, int y, int z, double layer_height) {
  return {.along_x = x, .along_y = y, .in_height = z, .layer_height = layer_height};
}

TEST(seed, keeps_the_volume_whatever_the_points_per_cell) {
  test::Seeded random;
  const Release release = random_release(test::grid_of(23, 17, 9.7), random);
  const double volume = test::volume_of(release.thickness);
  for (int x = 1; x <= 4; ++x) {
    for (int y = 1; y <= 4; ++y) {
      for (int z = 1; z <= 5; ++z) {
        for (const double layer_height : {0.37, 2.0, 9.7, 100.0}) {
          const Seeding s = seeding(x, y, z, layer_height);
          const SeedPoints points = seed_points({release}, s);
          ASSERT_NEAR(volume_of_points(points) / volume, 1, 1e-12) << x << " " << y << " " << z << " " << layer_height;
          ASSERT_EQ(points.size(), count_points({release}, s));
        }
      }
    }
  }
}

TEST(default_layer_height, is_half_the_thickness_of_most_of_the_volume) {
  const MapGrid grid = test::grid_of(10, 10, 20, 0, 0);
  const auto of = [&](auto thickness) { return test::raster_of(grid, thickness); };
  // A rim of 1 m holds half of the columns and a tenth of the volume.
  const Raster rim = of([](double x, double) { return x < 100 ? 9.0 : 1.0; });
  EXPECT_DOUBLE_EQ(default_layer_height(rim, 20), 4.5);
  EXPECT_DOUBLE_EQ(default_layer_height(rim, 3), 3) << "at most the spacing";
  EXPECT_DOUBLE_EQ(default_layer_height(of([](double, double) { return 1.2399; }), 20), 0.61) << "two digits";
  EXPECT_DOUBLE_EQ(default_layer_height(of([](double, double) { return 55.0; }), 100), 27);
  EXPECT_DOUBLE_EQ(default_layer_height(of([](double, double) { return 0.0; }), 20), 20) << "nothing released";
}

/// The cell that a point stands in.
std::size_t cell_of(const MapGrid& grid, const SeedPoints& points, std::size_t p) {
  return grid.index(static_cast<int>((points.x[p] - grid.west) / grid.cell),
                    static_cast<int>((points.y[p] - grid.south) / grid.cell));
}

std::vector<double> volumes_by_cell(const MapGrid& grid, const SeedPoints& points) {
  std::vector<double> volume(grid.count(), 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) volume[cell_of(grid, points, p)] += points.volume[p];
  return volume;
}

TEST(seed, keeps_the_volume_of_every_column) {
  test::Seeded random;
  const MapGrid grid = test::grid_of(8, 6, 10);
  const Release release = random_release(grid, random);
  Seeding s = seeding(3, 2, 2, 4);
  s.jitter = 0.5;
  const SeedPoints points = seed_points({release}, s);
  const std::vector<double> volume = volumes_by_cell(grid, points);
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_GE(points.height[p], 0);
    EXPECT_LE(points.height[p], release.thickness.values[cell_of(grid, points, p)]);
  }
  for (std::size_t i = 0; i < volume.size(); ++i) EXPECT_NEAR(volume[i], release.thickness.values[i] * 100, 1e-9);
}

TEST(seed, gives_what_would_be_slivers_to_thicker_columns_beside_them) {
  const MapGrid grid = test::grid_of(4, 3, 1, 0, 0);
  Release release{"A", test::raster_of(grid, [](double, double) { return 0.0; })};
  release.thickness.values = {2, 0.3,  0,      0,  //
                              2, 0.15, 0.0005, 0,  //
                              2, 0.01, 0,      0.001};
  const SeedPoints points = seed_points({release}, seeding(1, 1, 1, 2));
  const std::vector<double> volume = volumes_by_cell(grid, points);
  EXPECT_NEAR(volume_of_points(points), test::volume_of(release.thickness), 1e-12);
  // Each gives to all that are thicker, and hands on what it got: 0.0005 to 0.3, 0.15, 0.01 and 0.001, 0.01 to 2, 2 and
  // 0.15, and 0.15 to 2, 2, 2 and 0.3.
  const double first = 0.0005 / 0.461, second = (0.01 + first * 0.01) / 4.15,
               third = (0.15 * (1 + first + second)) / 6.3;
  EXPECT_NEAR(volume[11], 0.001 * (1 + first), 1e-12) << "nothing thicker is beside it";
  EXPECT_NEAR(volume[1], 0.3 * (1 + first + third), 1e-12) << "thick enough to stay";
  EXPECT_NEAR(volume[0], 2 * (1 + third), 1e-12);
  EXPECT_NEAR(volume[8], 2 * (1 + second + third), 1e-12);
  for (const std::size_t i : {5U, 6U, 9U}) EXPECT_EQ(volume[i], 0) << i;
  EXPECT_EQ(points.size(), count_points({release}, seeding(1, 1, 1, 2)));
}

/// A polygon's rim covers cells in part, by any share.
TEST(seed, leaves_no_sliver_beside_a_thick_column) {
  test::Seeded random;
  std::uniform_real_distribution<double> share(0, 1);
  for (const double thickness : {0.2, 1.5, 30.0}) {
    const MapGrid grid = test::grid_of(30, 30, 5, 0, 0);
    const Release release{"A", test::raster_of(grid, [&](double x, double y) {
                            const double beyond = std::hypot(x - 75, y - 75) - 50;
                            return thickness * (beyond < -5 ? 1 : beyond < 0 ? std::pow(share(random), 3) : 0);
                          })};
    for (const double layer_height : {0.1, 0.8, 5.0}) {
      const Seeding s = seeding(2, 2, 2, layer_height);
      const SeedPoints points = seed_points({release}, s);
      std::vector<double> largest(grid.count(), 0.0);
      for (std::size_t p = 0; p < points.size(); ++p) largest[cell_of(grid, points, p)] = points.volume[p];
      for (std::size_t p = 0; p < points.size(); ++p) {
        each_near(grid, grid.cell_of(cell_of(grid, points, p)), 1, [&](int x, int y) {
          EXPECT_GE(points.volume[p], 0.05 * largest[grid.index(x, y)]) << thickness << " " << layer_height;
        });
      }
      EXPECT_NEAR(volume_of_points(points) / test::volume_of(release.thickness), 1, 1e-12);
    }
  }
}

TEST(seed, spaces_points_evenly_and_lays_releases_in_one_cell_on_one_another) {
  const Release release{"A", test::raster_of(test::grid_of(1, 1, 10, 0, 0), [](double, double) { return 6.0; })};
  const SeedPoints points = seed_points({release}, seeding(2, 1, 2, 4));  // 6 m / 4 m * 2 = 3 points in height
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points.x, (std::vector<double>{2.5, 7.5, 2.5, 7.5, 2.5, 7.5}));
  EXPECT_EQ(points.y, std::vector<double>(6, 5.0));
  EXPECT_EQ(points.height, (std::vector<double>{1, 1, 3, 3, 5, 5}));
  EXPECT_EQ(points.volume, std::vector<double>(6, 100.0));
  const MapGrid grid = test::grid_of(1, 1, 10, 0, 0);
  const auto uniform = [&](double t) { return test::raster_of(grid, [=](double, double) { return t; }); };
  const SeedPoints laid = seed_points({{"A", uniform(4)}, {"B", uniform(2)}}, seeding(1, 1, 1, 4));
  EXPECT_EQ(laid.height, (std::vector<double>{2, 5}));
  EXPECT_EQ(laid.release, (std::vector<int>{0, 1}));
}

TEST(seed, shifts_points_by_no_more_than_the_jitter_and_each_time_alike) {
  const Release release{"A", test::raster_of(test::grid_of(20, 20, 10, 0, 0), [](double, double) { return 8.0; })};
  Seeding s = seeding(2, 2, 2, 4);
  const SeedPoints regular = seed_points({release}, s);
  s.jitter = 0.3;
  const SeedPoints one = seed_points({release}, s), same = seed_points({release}, s);
  s.jitter = 0.2;
  const SeedPoints other = seed_points({release}, s);
  EXPECT_EQ(one.x, same.x);
  EXPECT_NE(one.x, other.x);
  double most = 0;
  for (std::size_t p = 0; p < one.size(); ++p) most = std::max(most, std::abs(one.x[p] - regular.x[p]));
  EXPECT_LE(most, 0.3 * 5);
  EXPECT_GT(most, 0.3 * 5 * 0.9);
}

}  // namespace
}  // namespace talus::preprocess
