// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The computed sliding surface against closed forms, and what must hold on any ground.
#include "preprocess/release/sliding_surface.hpp"

#include "tests/preprocess/outlines.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

using namespace talus::test;

constexpr double slope_x = 0.3, slope_y = -0.2;

Raster plane(const MapGrid& grid) {
  return raster_of(grid,
                   [&](double x, double y) { return 500 + slope_x * (x - grid.west) + slope_y * (y - grid.south); });
}

/// Under an ellipse on a plane: depth d (1 - r^2), r = 1 on the outline, of volume pi a b d / 2.
struct Bowl {
  double depth = 20;
  Ellipse rim;

  double volume() const { return std::numbers::pi * rim.long_axis * rim.short_axis * depth / 2; }
  double at(double x, double y) const { return depth * (1 - rim.square(x, y)); }
};

Bowl bowl_on(const MapGrid& grid, double long_axis, double short_axis, double turn) {
  return {20,
          {(grid.west + grid.east()) / 2 + 1.7, (grid.south + grid.north()) / 2 - 3.1, long_axis, short_axis, turn}};
}

double largest_error(const SlidingSurface& s, const Raster& before, const Outline& outline, const Bowl& bowl) {
  double worst = 0;
  for (std::size_t c : outline.cells) {
    const double x = before.grid.x(static_cast<int>(c) % before.grid.columns),
                 y = before.grid.y(static_cast<int>(c) / before.grid.columns);
    worst = std::max(worst, std::abs(before.values[c] - s.surface.values[c] - bowl.at(x, y)));
  }
  return worst;
}

struct Errors {
  double surface, volume, depth, curvature;
};

/// Of a circle of 100 m: the surface and its volume where the depth is given, the depth where the volume is.
Errors errors_at(double cell) {
  const MapGrid grid = grid_of(static_cast<int>(300 / cell), static_cast<int>(300 / cell), cell);
  const Bowl bowl = bowl_on(grid, 100, 100, 0);
  const Raster before = plane(grid);
  const Outline outline = outline_on(grid, bowl.rim.polygon());
  const SlidingSurface by_depth = surface_of_depth(before, outline, bowl.depth),
                       by_volume = surface_of_volume(before, outline, bowl.volume());
  EXPECT_NEAR(by_depth.depth, bowl.depth, 1e-9);
  EXPECT_NEAR(by_volume.volume / bowl.volume(), 1, 1e-12);
  return {largest_error(by_depth, before, outline, bowl), std::abs(by_depth.volume / bowl.volume() - 1),
          std::abs(by_volume.depth / bowl.depth - 1), std::abs(by_depth.curvature * 100 * 100 / (4 * bowl.depth) - 1)};
}

TEST(sliding_surface, of_a_circle_on_a_plane_is_a_paraboloid_to_second_order) {
  const Errors coarse = errors_at(10), fine = errors_at(2.5);
  // The rim's operator misses a quadratic by at most q h^2 / 8 = d (h/R)^2 / 2, and the deepest centre stands up to d
  // (h/R)^2 / 2 above the deepest point; the volume misses a share of the rim's cells, (h/R)^2 of the whole.
  EXPECT_LT(coarse.surface, 20 * 0.01);
  EXPECT_LT(fine.surface, 20 * 0.01 / 16);
  EXPECT_LT(coarse.volume, 0.01);
  EXPECT_LT(fine.volume, 0.01 / 16);
  EXPECT_LT(coarse.depth, 0.01);
  EXPECT_LT(fine.depth, 0.01 / 16);
  EXPECT_LT(fine.curvature, 0.01 / 16);
  const double order = std::log(coarse.surface / fine.surface) / std::log(4.0);
  RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 1.7) << coarse.surface << " "
                        << fine.surface;  // second; less where the deepest centre happens to lie better on one grid
}

TEST(sliding_surface, of_an_ellipse_does_not_depend_on_how_the_grid_lies) {
  const MapGrid grid = grid_of(80, 80, 5);
  const Raster before = plane(grid);
  for (double degrees : {0.0, 17.0, 45.0, 90.0, 133.0}) {
    const Bowl bowl = bowl_on(grid, 150, 60, degrees * std::numbers::pi / 180);
    const Outline outline = outline_on(grid, bowl.rim.polygon());
    const SlidingSurface s = surface_of_volume(before, outline, bowl.volume());
    EXPECT_LT(largest_error(s, before, outline, bowl), 20 * std::pow(5.0 / 60, 2))
        << degrees;  // second order in cells over the short half axis
    EXPECT_EQ(s.touching, 0u);
  }
}

/// The grid and all on it, a quarter turn anticlockwise about the south-western corner.
Raster turned(const Raster& raster) {
  Raster result = raster;
  const int n = raster.grid.columns;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) result.at(n - 1 - row, column) = raster.at(column, row);
  return result;
}

TEST(sliding_surface, turns_with_the_ground) {
  test::Seeded random;
  const MapGrid grid = grid_of(60, 60, 10, 0, 0);
  const Raster before = raster_of(grid, Hills(grid, random)), before_turned = turned(before);
  const Ellipse rim{310, 290, 210, 130, 0.6};
  const Ellipse rim_turned{600 - 290, 310, 210, 130, 0.6 + std::numbers::pi / 2};
  const SlidingSurface s = surface_of_volume(before, outline_on(grid, rim.polygon()), 1e6),
                       t = surface_of_volume(before_turned, outline_on(grid, rim_turned.polygon()), 1e6);
  const Raster expected = turned(s.surface);
  for (std::size_t c = 0; c < expected.values.size(); ++c)
    ASSERT_NEAR(t.surface.values[c], expected.values[c], 1e-6);  // rounding, times the condition of the system
}

TEST(sliding_surface, meets_depth_and_volume_on_any_ground_and_stays_below_it) {
  test::Seeded random;
  const MapGrid grid = grid_of(60, 50, 10);
  std::normal_distribution<double> noise(0, 0.3);
  Hills hills(grid, random);
  const Raster before = raster_of(grid, [&](double x, double y) { return hills(x, y) + noise(random); });
  const Outline outline = outline_on(grid, Ellipse{grid.west + 310, grid.south + 240, 200, 130, 0.4}.polygon());
  for (double depth : {2.0, 10.0, 60.0}) {
    const SlidingSurface s = surface_of_depth(before, outline, depth);
    EXPECT_NEAR(s.depth, depth, 1e-9 * depth);
    const SlidingSurface v = surface_of_volume(before, outline, s.volume);  // the other way round, to the same surface
    EXPECT_NEAR(v.volume / s.volume, 1, 1e-9);
    EXPECT_NEAR(v.curvature, s.curvature, 1e-8 + 1e-6 * std::abs(s.curvature));
    std::size_t level = 0;
    for (std::size_t c = 0; c < before.values.size(); ++c) {
      ASSERT_LE(s.surface.values[c], before.values[c]);
      level += outline.number[c] >= 0 && s.surface.values[c] == before.values[c];
      if (outline.number[c] < 0) {
        ASSERT_EQ(s.surface.values[c], before.values[c]);
      }
    }
    EXPECT_EQ(s.touching, level);
  }
}

/// Five-point Laplacian times h^2 [m].
double bend(const Raster& z, int column, int row) {
  return z.at(column + 1, row) + z.at(column - 1, row) + z.at(column, row + 1) + z.at(column, row - 1) -
         4 * z.at(column, row);
}

TEST(sliding_surface, has_no_kink_where_it_leaves_ground_that_is_smooth) {
  const MapGrid grid = grid_of(80, 80, 5);
  const double middle = grid.west + 200;
  // A gully through the source, deeper than the surface beside it would be.
  const Raster before =
      raster_of(grid, [&](double x, double) { return 500 - 15 * std::exp(-std::pow((x - middle) / 30, 2)); });
  const Outline outline = outline_on(grid, Ellipse{middle, grid.south + 200, 150, 150, 0}.polygon());
  const SlidingSurface s = surface_of_depth(before, outline, 8);
  ASSERT_GT(s.touching, 20u);
  double sharpest = 0, ground = 0;
  for (std::size_t c : outline.cells) {
    const int column = static_cast<int>(c) % grid.columns, row = static_cast<int>(c) / grid.columns;
    bool rim = false;
    for (const auto& [dc, dr] : neighbour_steps) rim = rim || outline.number[grid.index(column + dc, row + dr)] < 0;
    if (rim) continue;
    sharpest = std::max(sharpest, std::abs(bend(s.surface, column, row)));
    ground = std::max(ground, std::abs(bend(before, column, row)));
    // Between the surface's own curvature and the ground's, never beyond.
    EXPECT_LE(bend(s.surface, column, row), std::max(s.curvature * 25, bend(before, column, row)) + 1e-6);
  }
  EXPECT_LE(sharpest, std::max(ground, s.curvature * 25) * (1 + 1e-9));  // a cut would leave a kink of slope times h
}

TEST(sliding_surface, bulges_with_the_ground_where_less_is_asked_than_a_flat_one_has) {
  const MapGrid grid = grid_of(60, 60, 5);
  const double x0 = grid.west + 150, y0 = grid.south + 150;
  const Raster dome =
      raster_of(grid, [&](double x, double y) { return 500 - 0.002 * (std::pow(x - x0, 2) + std::pow(y - y0, 2)); });
  const Outline outline = outline_on(grid, Ellipse{x0, y0, 100, 100, 0}.polygon());
  EXPECT_NEAR(surface_of_depth(dome, outline, 20).curvature, 0, 4e-5);  // laplace = -0.008 + 4 d / R^2; 1 % of either
  EXPECT_NEAR(surface_of_depth(dome, outline, 5).curvature, -0.008 + 0.002, 6e-5);
}

TEST(sliding_surface, goes_round_a_hole_and_under_several_polygons) {
  const MapGrid grid = grid_of(60, 60, 5);
  const Raster before = plane(grid);
  MapPolygon ring = Ellipse{grid.west + 150, grid.south + 150, 100, 100, 0}.polygon();
  MapPolygon hole = Ellipse{grid.west + 150, grid.south + 150, 40, 40, 0}.polygon();
  std::reverse(hole.rings[0].begin(), hole.rings[0].end());
  ring.rings.push_back(hole.rings[0]);
  const Outline outline = outline_on(grid, ring);
  const SlidingSurface s = surface_of_depth(before, outline, 10);
  // Ring of radii a, b: u = q/4 (b^2 - r^2 - (b^2 - a^2) ln(b/r) / ln(b/a)), deepest where r^2 = (b^2 - a^2) / (2
  // ln(b/a)).
  const double a = 40, b = 100, r2 = (b * b - a * a) / (2 * std::log(b / a)), r = std::sqrt(r2);
  const double share = (b * b - r2 - (b * b - a * a) * std::log(b / r) / std::log(b / a)) / 4;
  EXPECT_NEAR(s.curvature, 10 / share, 0.01 * 10 / share);  // (h / width of the ring)^2 = 0.7 %
  EXPECT_EQ(s.surface.at(30, 30), before.at(30, 30));
  const Outline two = outline_of(grid,
                                 {Ellipse{grid.west + 70, grid.south + 150, 50, 50, 0}.polygon(),
                                  Ellipse{grid.west + 220, grid.south + 150, 50, 50, 0}.polygon()},
                                 "two.gpkg");
  const SlidingSurface pair = surface_of_depth(before, two, 10);
  EXPECT_NEAR(pair.volume, 2 * std::numbers::pi * 50 * 50 * 5, 0.02 * 2 * std::numbers::pi * 50 * 50 * 5);  // 2 (h/R)^2
}

TEST(sliding_surface, takes_an_outline_through_cell_centres) {
  const MapGrid grid = grid_of(20, 20, 10);
  const Raster before = plane(grid);
  const auto square = [&](double west, double east) {
    return MapPolygon{{{{grid.west + west, grid.south + west},
                        {grid.west + east, grid.south + west},
                        {grid.west + east, grid.south + east},
                        {grid.west + west, grid.south + east}}},
                      {},
                      ""};
  };
  const Outline exact = outline_on(grid, square(45, 145)), wider = outline_on(grid, square(45 - 1e-4, 145 + 1e-4));
  const SlidingSurface a = surface_of_depth(before, exact, 10), b = surface_of_depth(before, wider, 10);
  for (std::size_t c = 0; c < before.values.size(); ++c)
    EXPECT_NEAR(a.surface.values[c], b.surface.values[c], 1e-3);  // slope of the bowl times what it is wider by
  EXPECT_NEAR(exact.area, 1e4, 1e-6);
}

std::vector<DepthPoint> points_of(const Bowl& bowl, int count, double error, std::mt19937& random) {
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  std::vector<DepthPoint> points;
  for (int i = 0; i < count; ++i) {
    const double x = bowl.rim.x + part(random) * bowl.rim.long_axis,
                 y = bowl.rim.y + part(random) * bowl.rim.short_axis;
    points.push_back({x, y, bowl.at(x, y), error});
  }
  return points;
}

TEST(sliding_surface, through_points_of_a_paraboloid_is_that_paraboloid) {
  test::Seeded random;
  const MapGrid grid = grid_of(60, 60, 5);
  const Bowl bowl = bowl_on(grid, 100, 100, 0);
  const Raster before = plane(grid);
  const Outline outline = outline_on(grid, bowl.rim.polygon());
  for (int count : {1, 2, 7}) {
    const SlidingSurface s = surface_through(before, outline, points_of(bowl, count, count == 7 ? 0.5 : 0.0, random));
    // Second order as above; between centres the reading of a parabola misses another q h^2 / 8. Points lie at r^2 <=
    // 0.5, and what they miss weighs at most 1 / (1 - r^2) = 2 in the middle.
    EXPECT_LT(largest_error(s, before, outline, bowl), 2 * 20 * 2 * std::pow(5.0 / 100, 2)) << count;
  }
  const SlidingSurface one = surface_through(before, outline, {{bowl.rim.x, bowl.rim.y, 20, 0}});
  EXPECT_LT(largest_error(one, before, outline, bowl), 20 * std::pow(5.0 / 100, 2));
}

TEST(sliding_surface, meets_points_exactly_or_within_their_errors) {
  test::Seeded random;
  const MapGrid grid = grid_of(80, 80, 5);
  const Bowl bowl = bowl_on(grid, 150, 100, 0.5);
  const Raster before = plane(grid);
  const Outline outline = outline_on(grid, bowl.rim.polygon());
  std::vector<DepthPoint> points;
  std::normal_distribution<double> scatter(0, 2);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const double x = bowl.rim.x + i * 23, y = bowl.rim.y + j * 23;
      points.push_back({x, y, std::max(1.0, bowl.at(x, y) + scatter(random)), 0});
    }
  }
  for (double misfit : surface_through(before, outline, points).misfit) EXPECT_NEAR(misfit, 0, 1e-6);
  const auto mean_square = [&](double error) {
    double sum = 0;
    for (DepthPoint& point : points) point.error = error;
    for (double misfit : surface_through(before, outline, points).misfit) sum += misfit * misfit;
    return sum / static_cast<double>(points.size());
  };
  EXPECT_NEAR(mean_square(1), 1, 1e-3);  // Reinsch's condition
  EXPECT_NEAR(mean_square(0.1), 0.01, 1e-5);
  const double all_the_slack =
      mean_square(100);  // only q is left: the best paraboloid, from which they are off by their scatter
  EXPECT_GT(all_the_slack, 1);
  EXPECT_LT(all_the_slack, 16);  // 4 times its variance
}

/// A slope broken in the middle of the source: no paraboloid.
double trough(double x, double y, const Ellipse& rim) {
  return 20 * (1 - rim.square(x, y)) * (1 + 0.5 * std::sin((x - rim.x) / 30));
}

TEST(sliding_surface, comes_nearer_the_more_points_there_are) {
  const MapGrid grid = grid_of(80, 80, 5);
  const Ellipse rim = bowl_on(grid, 150, 100, 0.5).rim;
  const Raster before = plane(grid);
  const Outline outline = outline_on(grid, rim.polygon());
  const auto rms = [&](int half) {
    std::vector<DepthPoint> points;
    for (int i = -3 * half; i <= 3 * half; ++i) {
      for (int j = -3 * half; j <= 3 * half; ++j) {
        const double x = rim.x + i * 50.0 / half, y = rim.y + j * 50.0 / half;
        if (rim.square(x, y) < 0.9) points.push_back({x, y, trough(x, y, rim), 0});
      }
    }
    const SlidingSurface s = surface_through(before, outline, points);
    double sum = 0;
    for (std::size_t c : outline.cells) {
      const double x = grid.x(static_cast<int>(c) % grid.columns), y = grid.y(static_cast<int>(c) / grid.columns);
      sum += std::pow(before.values[c] - s.surface.values[c] - trough(x, y, rim), 2);
    }
    return std::sqrt(sum / static_cast<double>(outline.cells.size()));
  };
  const double few = rms(1), more = rms(2), most = rms(4);
  EXPECT_LT(more, few / 4) << few << " " << more << " " << most;  // at least the square of their distance
  EXPECT_LT(most, more);                                          // what the grid itself misses is left
}

TEST(sliding_surface, through_points_converges_with_the_cell) {
  const auto depths = [](double cell) {
    const MapGrid grid = grid_of(static_cast<int>(300 / cell), static_cast<int>(300 / cell), cell, 0, 0);
    const Raster before = plane(grid);
    const SlidingSurface s = surface_through(before, outline_on(grid, Ellipse{150, 150, 120, 80, 0.3}.polygon()),
                                             {{120, 140, 15, 0}, {190, 160, 8, 0}, {150, 190, 9, 0}});
    return std::array<double, 2>{value_at(before, 150, 150) - value_at(s.surface, 150, 150),
                                 value_at(before, 90, 130) - value_at(s.surface, 90, 130)};
  };
  const auto coarse = depths(20), middle = depths(10), fine = depths(5), finest = depths(2.5);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(middle[i] - finest[i]), 0.6 * std::abs(coarse[i] - finest[i]) + 0.02)
        << i << ": " << coarse[i] << " " << middle[i] << " " << fine[i] << " " << finest[i];
    EXPECT_LT(std::abs(fine[i] - finest[i]), 0.05);  // 0.3 % of the depth at 16 cells over the short half axis
  }
}

}  // namespace
}  // namespace talus::preprocess
