// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The terrains in data_samples/ are what talus-make-terrain makes.
#include <map>

#include "common/gis/crs.hpp"
#include "common/gis/polygons.hpp"
#include "common/gis/read_raster.hpp"
#include "data_samples/hard_terrains.hpp"
#include "data_samples/terrains.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/scene/prepare.hpp"
#include "tests/places.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

const std::filesystem::path folder = std::filesystem::path(TALUS_SOURCE_DIR) / "data_samples";

void expect_committed(const std::string& kind, const samples::Sample& sample) {
  for (const auto& [stem, raster] : sample.rasters) {
    const Raster file = read_raster(folder / kind / (stem + ".tif"));
    EXPECT_EQ(crs_name(file.grid.crs_wkt), "EPSG:32633");
    ASSERT_EQ(file.values.size(), raster.values.size());
    // Rounded to cm and kept in single precision; another machine's sine may round the other way.
    for (std::size_t i = 0; i < file.values.size(); ++i) {
      ASSERT_EQ(std::isnan(file.values[i]), std::isnan(raster.values[i]));
      if (std::isnan(file.values[i])) continue;
      ASSERT_NEAR(file.values[i], raster.values[i], 0.0102) << kind << "/" << stem;
    }
  }
  for (const auto& [stem, features] : sample.outlines) {
    const auto polygons = read_polygons(folder / kind / (stem + ".geojson"), "");
    ASSERT_EQ(polygons.size(), features.size());
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      EXPECT_EQ(polygons[p].name, features[p].name);
      ASSERT_EQ(polygons[p].rings.at(0).size(), features[p].outline.size());
      for (std::size_t i = 0; i < features[p].outline.size(); ++i) {
        ASSERT_NEAR(polygons[p].rings[0][i][0], features[p].outline[i][0], 0.0102);
        ASSERT_NEAR(polygons[p].rings[0][i][1], features[p].outline[i][1], 0.0102);
      }
    }
  }
}

samples::Sample hard_sample(const samples::HardTerrain& terrain, double cell, const samples::Pose& pose = {}) {
  return samples::LaidTerrain(terrain, cell, pose).sample();
}

TEST(samples, are_what_the_program_makes) {
  expect_committed("bent-gully", hard_sample(samples::bent_gully(), 4));
  expect_committed("cliff-bench", hard_sample(samples::cliff_bench(), 2.5));
  expect_committed("inclined-plane", samples::inclined_plane(10));
  expect_committed("parabolic-chute", samples::parabolic_chute(10));
  expect_committed("raw-valley", samples::raw_valley(10, 1));
  expect_committed("rock-slope", samples::rock_slope(10));
  expect_committed("rough-slope", hard_sample(samples::rough_slope(), 2));
  expect_committed("thinning-slide", hard_sample(samples::thinning_slide(), 5));
  expect_committed("valley", samples::valley(10));
  expect_committed("weathered-slope", hard_sample(samples::weathered_slope(), 5));
}

TEST(samples, are_small) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".tif") continue;
    EXPECT_LE(entry.file_size(), 200'000u) << entry.path();
  }
}

TEST(samples, hard_terrains_lie_on_the_map_as_asked) {
  const samples::HardTerrain terrain = samples::bent_gully();
  const Raster as_is = hard_sample(terrain, 4).rasters.at(0).second;
  const Raster mirrored = hard_sample(terrain, 4, {true, 0}).rasters.at(0).second;
  const Raster quarter = hard_sample(terrain, 4, {false, 90}).rasters.at(0).second;
  ASSERT_EQ(quarter.grid.columns, as_is.grid.rows);
  ASSERT_EQ(quarter.grid.rows, as_is.grid.columns);
  const int rows = as_is.grid.rows;
  // Rounded to cm.
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < as_is.grid.columns; ++i) {
      ASSERT_NEAR(mirrored.at(i, rows - 1 - j), as_is.at(i, j), 0.0102);
      ASSERT_NEAR(quarter.at(rows - 1 - j, i), as_is.at(i, j), 0.0102);
    }
  }
  // By 30 degrees counter-clockwise: 100 m down the slope from the middle is 86.6 m east and 50 m north of it.
  const Raster oblique = hard_sample(terrain, 4, {false, 30}).rasters.at(0).second;
  const double x = oblique.grid.columns * 2 + 86.60254, y = oblique.grid.rows * 2 + 50;
  const auto own = samples::LaidTerrain(terrain, 4, {false, 30}).own(x, y);
  EXPECT_NEAR(own[0], terrain.width / 2 + 100, 1e-4);
  EXPECT_NEAR(own[1], terrain.height / 2, 1e-4);
  // Half a cell on ground of at most 47 degrees.
  EXPECT_NEAR(oblique.at(static_cast<int>(x / 4), static_cast<int>(y / 4)),
              terrain.ground(terrain.width / 2 + 100, terrain.height / 2), 3.1);
}

Options valley_options() {
  Options options;
  options.before_dem = folder / "valley" / "before_dem.tif";
  options.after_dem = folder / "valley" / "after_dem.tif";
  return options;
}

TEST(samples, valley_is_a_scene_of_a_few_thousand_points) {
  const Prepared prepared = prepare(valley_options(), Points::seeded);
  EXPECT_GT(prepared.point_count, 1000u);
  EXPECT_LT(prepared.point_count, 3000u);
  EXPECT_GT(prepared.total.volume, 150e3);
  EXPECT_LT(prepared.total.volume, 300e3);
  EXPECT_LT(prepared.total.max_vertical, 30);
}

TEST(samples, valley_deposit_has_the_volume_of_its_scar) {
  const Raster before = read_raster(valley_options().before_dem), after = read_raster(valley_options().after_dem);
  double lowered = 0, raised = 0;
  for (std::size_t i = 0; i < before.values.size(); ++i) {
    const double change = 100 * (after.values[i] - before.values[i]);
    (change < 0 ? lowered : raised) += std::abs(change);
  }
  EXPECT_NEAR(raised / lowered, 1, 0.005);  // formulas sampled at 10 m
}

TEST(samples, valley_polygon_and_region_agree) {
  Options options = valley_options();
  const double by_region = prepare(options, Points::counted).total.volume;
  options.source.polygon = folder / "valley" / "source.geojson";
  // The outline cuts the cells on it; the region takes them whole.
  EXPECT_NEAR(prepare(options, Points::counted).total.volume / by_region, 1, 0.02);
}

TEST(samples, valley_outline_holds_source_and_deposit) {
  const Raster before = read_raster(valley_options().before_dem), after = read_raster(valley_options().after_dem);
  auto outline = read_polygons(folder / "valley" / "surveyed_outline.geojson", before.grid.crs_wkt);
  check_polygons(outline, "surveyed_outline.geojson");
  const auto covered = coverage(before.grid, outline[0], "surveyed_outline.geojson");
  double inside = 0, all = 0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const double change = std::abs(after.values[i] - before.values[i]);
    all += change;
    inside += covered[i] * change;
  }
  EXPECT_GT(inside / all, 0.97);
}

TEST(samples, releases_on_plane_and_chute_have_their_volume) {
  Options options;
  options.base_dem = folder / "inclined-plane" / "dem.tif";
  options.release.resize(1);
  options.release[0].thickness_raster = folder / "inclined-plane" / "release_thickness.tif";
  EXPECT_NEAR(prepare(options, Points::seeded).total.volume, 100 * 80 * 8, 1e-6);
  options.release[0].thickness_raster.clear();
  options.release[0].polygons = folder / "inclined-plane" / "release.geojson";
  EXPECT_NEAR(prepare(options, Points::seeded).total.volume, 100 * 80 * 8, 1e-6);
  options.base_dem = folder / "parabolic-chute" / "dem.tif";
  options.release[0].polygons = folder / "parabolic-chute" / "release.geojson";
  EXPECT_NEAR(prepare(options, Points::seeded).total.volume, 2 * 53 * 76 + 3 * 47 * 52, 1e-6);
}

TEST(samples, releases_on_hard_terrains_are_as_thick_as_they_say) {
  struct Release {
    const char* name;
    double volume, most;  ///< [m3], [m]
  };
  for (const Release& release : {Release{"rough-slope", 4295, 1}, Release{"bent-gully", 7763, 5},
                                 Release{"cliff-bench", 16500, 5}, Release{"thinning-slide", 53462, 18}}) {
    Options options;
    options.base_dem = folder / release.name / "dem.tif";
    options.release.resize(1);
    options.release[0].thickness_raster = folder / release.name / "release_thickness.tif";
    const Prepared prepared = prepare(options, Points::counted);
    EXPECT_NEAR(prepared.total.volume, release.volume, 0.5) << release.name;
    EXPECT_LE(prepared.total.max_vertical, release.most) << release.name;
    EXPECT_GT(prepared.total.max_vertical, 0.9 * release.most) << release.name;
  }
}

}  // namespace
}  // namespace talus::preprocess
