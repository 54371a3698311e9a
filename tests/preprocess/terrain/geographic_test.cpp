// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation models in degrees and in feet, brought to metres on request.
#include "common/gis/coordinates.hpp"
#include "common/gis/crs.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

using test::fault_of;
using test::Scratch;

/// A slope near 13.5 E, 47.1 N, on cells of about 10 m, in degrees: before, and after with a bowl taken out.
struct InDegrees {
  Scratch scratch;
  Options options;
  static constexpr double west = 13.5, south = 47.1, cell = 0.0001, radius = 200, depth = 20;
  const std::string utm = metric_crs("EPSG:32633");

  explicit InDegrees(double metres = 1) {
    write("before.tif", 0, metres);
    write("after.tif", depth, metres);
    options.before_dem = scratch / "before.tif";
    options.after_dem = scratch / "after.tif";
    options.grid.layer_height = 5;
  }
  double volume() const { return 0.5 * M_PI * radius * radius * depth; }  // of a paraboloid

  /// Heights at places in degrees, with a paraboloid of `bowl` metres cut out of a slope at the middle.
  std::vector<double> heights(std::vector<double> x, std::vector<double> y, double bowl) const {
    x.push_back(west + 75 * cell);
    y.push_back(south + 50 * cell);
    transform_places(crs_by_name("EPSG:4326"), utm, x, y);
    std::vector<double> z;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double dx = x[i] - x.back(), dy = y[i] - y.back();
      z.push_back(1500 + 0.3 * dx - 0.1 * dy - bowl * std::max(0.0, 1 - (dx * dx + dy * dy) / (radius * radius)));
    }
    return z;
  }
  void write(const char* name, double bowl, double metres) const {
    Raster raster{{150, 100, west, south, cell, crs_by_name("EPSG:4326")}, {}};
    std::vector<double> x, y;
    for (int r = 0; r < 100; ++r)
      for (int c = 0; c < 150; ++c) x.push_back(raster.grid.x(c)), y.push_back(raster.grid.y(r));
    raster.values = heights(x, y, bowl);
    for (double& z : raster.values) z /= metres;
    write_geotiff(scratch / name, raster, {});
  }
  std::string path(const char* name) const { return (scratch / name).string(); }
};

TEST(geographic, a_pair_in_degrees_is_refused_with_two_ways_out) {
  const InDegrees scene;
  EXPECT_EQ(fault_of<DataError>([&] { prepare(scene.options, Points::counted); }),
            scene.path("before.tif") +
                ": CRS is EPSG:4326, in degrees (this stage needs metres). Reproject: gdalwarp -t_srs EPSG:32633 -r "
                "bilinear " +
                scene.path("before.tif") + " before_utm.tif; or set working_crs = \"utm\" in [preprocess]");
}

TEST(geographic, a_pair_in_degrees_keeps_its_volume_in_its_utm_zone) {
  InDegrees scene;
  scene.options.working_crs = "utm";
  const Prepared prepared = prepare(scene.options, Points::counted);
  EXPECT_EQ(crs_name(prepared.domain.grid.crs_wkt), "EPSG:32633");
  EXPECT_NEAR(prepared.domain.grid.cell, 9.2, 0.06);  // of 7.6 x 11.1 m
  // Cells of 9 m on a bowl of 200 m: the rim below the threshold of half a metre holds (0.5 / 20)^2 of the volume, the
  // scale of UTM 1 in a thousand of the area.
  EXPECT_NEAR(prepared.total.volume / scene.volume(), 1, 0.003);
}

TEST(geographic, the_zone_may_be_named_too) {
  InDegrees scene;
  scene.options.working_crs = "EPSG:32632";
  const Prepared prepared = prepare(scene.options, Points::counted);
  EXPECT_EQ(crs_name(prepared.domain.grid.crs_wkt), "EPSG:32632");
  // Zone 32 is 4.5 degrees away: its scale is 0.9996 + 0.5 (4.5 deg cos 47 deg)^2 = 1.0010, squared for the area.
  EXPECT_NEAR(prepared.total.volume / scene.volume(), std::pow(1.0010 / 0.99980, 2), 0.003);
}

TEST(geographic, points_in_degrees_are_moved_to_the_utm_zone) {
  InDegrees scene;
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<double> x, y;
  for (int i = 0; i < 15000; ++i) {
    x.push_back(scene.west + 150 * scene.cell * part(random));
    y.push_back(scene.south + 100 * scene.cell * part(random));
  }
  const std::vector<double> z = scene.heights(x, y, scene.depth);
  std::string table = "longitude,latitude,height\n";
  for (std::size_t i = 0; i < x.size(); ++i) table += fmt::format("{:.8f},{:.8f},{:.4f}\n", x[i], y[i], z[i]);
  scene.options.after_dem = scene.scratch.write("after.csv", table);
  scene.options.working_crs = "utm";
  const Prepared prepared = prepare(scene.options, Points::counted);
  EXPECT_EQ(crs_name(prepared.domain.grid.crs_wkt), "EPSG:32633");
  // Linear in triangles of 10 m: a paraboloid of curvature 2 depth / radius^2 = 1e-3 / m is off by up to 1e-2 m.
  EXPECT_NEAR(prepared.total.volume / scene.volume(), 1, 0.005);
}

TEST(geographic, heights_in_feet_that_the_files_do_not_declare_are_named_in_the_recipe) {
  InDegrees scene(0.3048);
  scene.options.working_crs = "utm";
  scene.options.vertical_unit = VerticalUnit::foot;
  EXPECT_NEAR(prepare(scene.options, Points::counted).total.volume / scene.volume(), 1, 0.003);
}

TEST(geographic, a_file_without_crs_has_no_utm_zone) {
  InDegrees scene;
  test::write(scene.scratch, "local.tif", test::raster_of(test::grid_of(5, 5, 10), [](double, double) { return 1.0; }));
  scene.options.before_dem = scene.scratch / "local.tif";
  scene.options.working_crs = "utm";
  const std::string text = fault_of<DataError>([&] { prepare(scene.options, Points::counted); });
  EXPECT_EQ(text.find(scene.path("local.tif") + ": has no CRS (so its UTM zone cannot be told). Give it one: "), 0u)
      << text;
}

}  // namespace
}  // namespace talus::preprocess
