// The terrains in data_samples/ are what talus-make-terrain makes.
#include <map>

#include "common/gis/crs.hpp"
#include "common/gis/polygons.hpp"
#include "common/gis/read_raster.hpp"
#include "data_samples/terrains.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/scene/prepare.hpp"
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

TEST(samples, are_what_the_program_makes) {
  expect_committed("inclined-plane", samples::inclined_plane(10));
  expect_committed("parabolic-chute", samples::parabolic_chute(10));
  expect_committed("raw-valley", samples::raw_valley(10, 1));
  expect_committed("rock-slope", samples::rock_slope(10));
  expect_committed("valley", samples::valley(10));
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

}  // namespace
}  // namespace talus::preprocess
