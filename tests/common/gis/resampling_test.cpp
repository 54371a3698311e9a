// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "common/gis/crs.hpp"
#include "common/gis/resampling.hpp"
#include "tests/common/rasters.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus {
namespace {

using test::epsg;
using test::random_raster;
using test::volume;

/// Plate carree: true along meridians, too long along parallels.
TEST(ground_scale, of_utm_is_its_factor_on_the_central_meridian_and_axes_are_told_apart) {
  const auto scale = ground_scale_at(crs_by_name("EPSG:32633"), 500000, 5100000);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->x, 0.9996, 1e-7);  // the definition of UTM
  EXPECT_NEAR(scale->y, 0.9996, 1e-7);
  EXPECT_NEAR(scale->area, 0.9996 * 0.9996, 1e-7);
  const auto plate = ground_scale_at(crs_by_name("EPSG:32662"), 1000000, 5000000);
  if (!plate) GTEST_SKIP() << "this PROJ does not know EPSG:32662";
  EXPECT_NEAR(plate->y, 1, 0.01);
  EXPECT_GT(plate->x, 1.3);
}

/// Web Mercator at latitude p: a / (N cos p) along the parallel and a / M along the meridian times sec p, with the
/// radii of curvature N and M (Snyder 1987).
TEST(ground_scale, of_web_mercator_is_that_of_its_latitude) {
  const double a = 6378137, y = 5012341, latitude = 2 * std::atan(std::exp(y / a)) - std::numbers::pi / 2;
  const double e2 = 0.00669437999014, w = 1 - e2 * std::pow(std::sin(latitude), 2);
  const auto scale = ground_scale_at(crs_by_name("EPSG:3857"), -8000000, y);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->x, std::sqrt(w) / std::cos(latitude), 1e-8);
  EXPECT_NEAR(scale->y, std::pow(w, 1.5) / (1 - e2) / std::cos(latitude), 1e-8);
  EXPECT_NEAR(scale->area, 1.74, 0.03) << "at 41 degrees";
}

TEST(ground_scale, of_a_grid_is_worst_where_it_is_worst) {
  const MapGrid wide{
      .columns = 1000, .rows = 10, .west = 200000, .south = 100000, .cell = 600, .crs_wkt = crs_by_name("EPSG:32633")};
  const auto scale = grid_scale(wide);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->middle.x, 0.9996, 1e-6);
  EXPECT_GT(scale->worst.falsity(), 0.0006) << "300 km from the central meridian";
  EXPECT_FALSE(grid_scale(MapGrid{.columns = 9, .rows = 9, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""}));
}

Raster plane(const MapGrid& grid) {
  return test::raster_of(grid, [](double x, double y) { return 3 * x - 2 * y + 7; });
}

TEST(ResampleThickness, keeps_the_volume_on_random_grids) {
  test::Seeded random;
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Raster source =
        random_raster({20 + trial, 30, 5e5 * unit(random), 5e6 * unit(random), 0.5 + 20 * unit(random), ""},
                      random.number + static_cast<unsigned>(trial));
    const MapGrid& from = source.grid;
    const double cell = 0.3 + 30 * unit(random);
    // A target that covers the source whole, at any registration.
    MapGrid to{0, 0, from.west - cell * (1 + unit(random)), from.south - cell * (1 + unit(random)), cell, ""};
    to.columns = static_cast<int>(std::ceil((from.east() - to.west) / cell)) + 1;
    to.rows = static_cast<int>(std::ceil((from.north() - to.south) / cell)) + 1;
    const Raster result = resample_thickness(source, to);
    // Coordinates of 5e6 m are known to 1e-9 m, so an overlap of cells of 0.3 m to 3e-9 of itself; hundreds of them
    // average out (largest of 20,000 trials: 7e-12).
    EXPECT_NEAR(volume(result) / volume(source), 1, 1e-10) << "trial " << trial;
  }
}

TEST(ResampleThickness, keeps_the_volume_inside_both_extents) {
  const Raster source = random_raster({10, 10, 0, 0, 10, ""}, 1);
  const Raster result =
      resample_thickness(source, {30, 30, 20, 30, 1, ""});  // the 3 x 3 source cells from column 2, row 3
  double expected = 0;
  for (int row = 3; row < 6; ++row)
    for (int column = 2; column < 5; ++column) expected += source.at(column, row) * 100;
  EXPECT_NEAR(volume(result) / expected, 1, 1e-12);
}

TEST(ResampleThickness, is_nodata_outside_and_takes_nodata_inside_as_zero) {
  const Raster source = test::small_raster({2, 2, 0, 0, 10, ""}, {4, std::nan(""), 4, 4});
  const Raster result = resample_thickness(source, {3, 1, 0, 0, 20, ""});
  EXPECT_DOUBLE_EQ(result.at(0, 0), 3);
  EXPECT_TRUE(std::isnan(result.at(1, 0)));
  EXPECT_TRUE(std::isnan(result.at(2, 0)));
}

TEST(ResampleThickness, does_not_depend_on_where_on_earth_it_is) {
  const Raster here = random_raster({40, 40, 0, 0, 10, ""}, 2);
  Raster there = here;
  there.grid.west += 500000;
  there.grid.south += 5000000;
  const Raster a = resample_thickness(here, {57, 57, 0.7, 0.3, 7, ""});
  const Raster b = resample_thickness(there, {57, 57, 500000.7, 5000000.3, 7, ""});
  for (std::size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 1e-6);
}

TEST(ResampleThickness, refuses_another_crs) {
  const std::string text = test::fault_of<DataError>([] {
    resample_thickness(random_raster({2, 2, 0, 0, 1, epsg(32611)}, 3), {2, 2, 0, 0, 1, epsg(32612)});
  });
  EXPECT_EQ(text,
            "a thickness in EPSG:32611 is wanted in EPSG:32612 (its volume would not survive a change of CRS). Bring "
            "the elevations to the thickness's CRS, with working_crs in the recipe");
}

TEST(ResampleElevation, copies_where_the_cells_are_the_same_and_takes_the_area_mean_of_cells_that_are_cut) {
  const Raster source = random_raster({10, 10, 1000, 2000, 10, ""}, 4);
  const Raster result = resample_elevation(source, {4, 4, 1080, 1970, 10, ""});
  EXPECT_EQ(result.at(0, 3), source.at(8, 0));
  EXPECT_EQ(result.at(1, 3), source.at(9, 0));
  EXPECT_TRUE(std::isnan(result.at(2, 3)));
  EXPECT_TRUE(std::isnan(result.at(0, 2)));
  const Raster three = test::small_raster({3, 3, 0, 0, 10, ""}, {1, 2, 6, 1, 2, 6, 1, 2, 6});
  const Raster mean = resample_elevation(three, {2, 2, 0, 0, 15, ""});
  EXPECT_NEAR(mean.at(0, 0), (1 * 10 + 2 * 5) / 15.0, 1e-12);
  EXPECT_NEAR(mean.at(1, 1), (2 * 5 + 6 * 10) / 15.0, 1e-12);
}

TEST(ResampleElevation, reproduces_a_plane_on_finer_and_coarser_grids) {
  const Raster source = plane({40, 40, 0, 0, 10, ""});
  for (const MapGrid& grid : {MapGrid{8, 8, 53, 71, 2.5, ""}, MapGrid{8, 8, 53, 71, 7, ""},
                              MapGrid{8, 8, 53, 71, 10, ""}, MapGrid{8, 8, 50, 70, 20, ""}}) {
    const Raster result = resample_elevation(source, grid);
    const Raster exact = plane(grid);
    for (std::size_t i = 0; i < exact.values.size(); ++i)
      EXPECT_NEAR(result.values[i], exact.values[i], 1e-9) << "cell " << grid.cell;
  }
}

TEST(ResampleElevation, keeps_holes_as_they_are) {
  Raster source = plane({10, 10, 0, 0, 10, ""});
  source.at(5, 5) = std::nan("");
  const Raster result = resample_elevation(source, {20, 20, 0, 0, 5, ""});
  int holes = 0;
  for (const double value : result.values) holes += std::isnan(value) ? 1 : 0;
  EXPECT_EQ(holes, 4);
  for (int row = 10; row < 12; ++row)
    for (int column = 10; column < 12; ++column) EXPECT_TRUE(std::isnan(result.at(column, row)));
}

TEST(ResampleElevation, goes_through_another_crs_and_back) {
  // A smooth hill in UTM 11 to UTM 12 and back again: what is lost is interpolation alone.
  MapGrid grid{60, 60, 780000, 5480000, 20, epsg(32611)};
  Raster source{grid, std::vector<double>(grid.count())};
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column)
      source.at(column, row) = 100 * std::sin(column / 15.0) * std::cos(row / 20.0);
  const Raster there = resample_elevation(source, {80, 80, 344600, 5474900, 20, epsg(32612)});
  const Raster back = resample_elevation(there, {20, 20, 780400, 5480400, 20, epsg(32611)});
  double worst = 0;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) {
      ASSERT_FALSE(std::isnan(back.at(column, row)));
      worst = std::max(worst, std::abs(back.at(column, row) - source.at(column + 20, row + 20)));
    }
  // Twice the error of linear interpolation, h^2/8 |z''| a direction: 2 * 100 (1/15^2 + 1/20^2) / 8 = 0.17 m.
  EXPECT_LT(worst, 0.17);
}

/// Six points keep a surface of the fifth degree, with it a quadratic one, which linear interpolation bends by h^2/8
/// times its curvature.
TEST(ResampleElevation, keeps_a_surface_of_the_fifth_degree_when_moved_by_part_of_a_cell) {
  const auto bowl = [](double x, double y) {
    return 0.02 * x * x - 0.01 * x * y + 0.03 * y * y + 1e-8 * std::pow(x, 5) - 1e-8 * std::pow(y, 5);
  };
  Raster source = test::raster_of({30, 30, -150, -150, 10, ""}, bowl);
  MapGrid moved{20, 20, -97, -104, 10, ""};
  const Raster quintic = resample_elevation(source, moved, Interpolation::quintic),
               linear = resample_elevation(source, moved);
  double worst = 0;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) {
      EXPECT_NEAR(quintic.at(column, row), bowl(moved.x(column), moved.y(row)), 1e-9);
      worst = std::max(worst, std::abs(linear.at(column, row) - bowl(moved.x(column), moved.y(row))));
    }
  EXPECT_GT(worst, 0.5);
  source.at(15, 15) = std::nan("");  // beside a hole: as linear interpolation does
  const Raster beside = resample_elevation(source, moved, Interpolation::quintic);
  EXPECT_FALSE(std::isnan(beside.at(7, 10)));
}

TEST(ResampleElevation, needs_a_crs_on_both_sides_or_on_none) {
  const std::string text = test::fault_of<DataError>([] {
    resample_elevation(random_raster({2, 2, 0, 0, 1, ""}, 5), {2, 2, 0, 0, 1, epsg(32611)});
  });
  EXPECT_EQ(text,
            "an elevation raster in local metric coordinates is wanted in EPSG:32611 (one of the two files names no "
            "CRS). Give it one: gdal_translate -a_srs EPSG:<code> in.tif out.tif");
}

}  // namespace
}  // namespace talus
