// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What makes the maps ready for a GIS: styles, outlines at thresholds, the project.
#include <functional>
#include <regex>

#include <fmt/format.h>

#include "common/gis/raster_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/maps.hpp"
#include "postprocess/writers/job.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;
using test::small_run;

namespace fs = std::filesystem;

TEST(Styles, have_the_thresholds_of_hazard_work) {
  auto run = small_run();
  run.maps.peak_pressure_kPa = test::block(run.maps.grid, 3, 35, 10, 20, 40);
  EXPECT_EQ(pressure_limits(run.maps.peak_pressure_kPa), (std::vector<double>{1, 3, 5, 10}));
  EXPECT_EQ(pressure_limits(small_run().maps.peak_pressure_kPa), (std::vector<double>{1, 3, 5, 10, 100}))
      << "880 kPa at most";
  EXPECT_EQ(speed_limits({60}), (std::vector<double>{0.5, 1, 5, 10, 25, 50}));
  EXPECT_EQ(speed_limits({160}), (std::vector<double>{0.5, 5, 10, 25, 50, 100}));
  EXPECT_EQ(thickness_limits({}, {80}), (std::vector<double>{0.1, 2, 5, 10, 25, 50}));
  EXPECT_EQ(thickness_limits({1, 3}, {80}), (std::vector<double>{1, 3}));
}

/// Whatever the range of values: no class that holds none, none that holds nearly all of a range of decades, and the
/// limits are round.
TEST(Styles, fit_the_range_of_values) {
  for (int n = -60; n <= 120; ++n) {
    const double largest = std::pow(1.1, n);
    for (const auto& limits : {thickness_limits({}, {largest}), speed_limits({largest}), pressure_limits({largest})}) {
      EXPECT_LT(limits.back(), largest) << "the last class is empty";
      EXPECT_GE(limits.size(), 4U) << largest;
      EXPECT_LE(limits.size(), 7U) << largest;
      EXPECT_TRUE(std::is_sorted(limits.begin(), limits.end(), std::less_equal<>())) << largest;
    }
    EXPECT_LE(std::min(largest, 1000.0) / thickness_limits({}, {largest}).back(), 5 + 1e-9) << largest;
  }
  EXPECT_EQ(thickness_limits({}, {0.8}), (std::vector<double>{0.02, 0.05, 0.1, 0.5}));
  EXPECT_EQ(thickness_limits({}, {0}), (std::vector<double>{0.1, 0.5, 1, 2})) << "a map of nothing has a legend too";
}

TEST(Styles, suit_each_map) {
  const auto run = small_run();
  EXPECT_EQ(map_style("deposit_thickness", run.maps, {1, 3}).classes.back().label, "> 3 m");
  EXPECT_EQ(map_style("deposit_thickness_scar", run.maps, {}).classes.front().label, "0.1 \u2013 0.5 m");
  EXPECT_EQ(map_style("peak_pressure", run.maps, {1, 3}).classes.back().label, "> 100 kPa");
  EXPECT_EQ(map_style("peak_speed", run.maps, {1, 3}).classes.back().label, "> 10 m/s");
  EXPECT_EQ(map_style("difference_to_survey", run.maps, {1, 3}).classes.front().label, "< \u22125 m");
  EXPECT_EQ(map_style("arrival_time", run.maps, {}).hidden_from, map_style("arrival_time", run.maps, {}).hidden_to);
}

TEST(Styles, round_the_times_of_arrival) {
  const auto run = small_run();  // up to 17 s
  EXPECT_EQ(time_limits(run.maps.arrival_time), (std::vector<double>{5, 10, 15}));
  auto never = run;
  never.maps.arrival_time.assign(run.maps.grid.count(), nan);
  EXPECT_EQ(time_limits(never.maps.arrival_time).size(), 1U);
  for (int n = 0; n < 137; ++n) {
    const double last = 0.3 * std::pow(1.07, n);
    auto some = run;
    some.maps.arrival_time.assign(1, last);
    const auto limits = time_limits(some.maps.arrival_time);
    EXPECT_GE(limits.size(), 2U) << last;
    EXPECT_LE(limits.size(), 6U) << last;
    EXPECT_LE(last - limits.back(), 2 * limits.front()) << "the last class is not most of it";
  }
}

TEST(Outlines, stand_at_the_thresholds) {
  const auto run = small_run();
  Options options;
  options.classes = {1, 3};
  options.footprint_threshold = 1;
  options.deposit_threshold = 2;
  const auto layers = map_outlines(run, options, {});
  ASSERT_EQ(layers.size(), 4U);
  EXPECT_EQ(layers[0].name, "footprint");
  EXPECT_EQ(layers[0].features.at(0).name, "peak thickness > 1 m");
  ASSERT_EQ(layers[1].features.size(), 3U) << "the classes, and the threshold of the score";
  EXPECT_EQ(layers[1].features[1].numbers, (std::vector<std::pair<std::string, double>>{{"threshold_m", 2}}));
  EXPECT_EQ(layers[2].features.size(), 5U);
  EXPECT_EQ(layers[3].features.at(0).polygons.size(), 1U);
}

TEST(Outlines, of_the_survey_are_its_own_polygons_where_it_has_them) {
  const auto run = small_run();
  Survey survey;
  survey.name = "mapped";
  survey.grid = run.maps.grid;
  survey.footprint = test::block(run.maps.grid, 3, 30, 10, 20, 1);
  survey.footprint_threshold = 0.5;
  survey.polygons = {{{{{0, 0}, {1, 0}, {1, 1}}}, {}, ""}};
  const auto given = map_outlines(run, {}, survey);
  EXPECT_EQ(given.back().name, "survey");
  EXPECT_EQ(given.back().features.at(0).polygons.at(0).rings, survey.polygons[0].rings);
  survey.polygons.clear();
  survey.deposit = run.maps.deposit_thickness;
  const auto drawn = map_outlines(run, {}, survey);
  ASSERT_EQ(drawn.back().features.size(), 2U);
  EXPECT_EQ(drawn.back().features[0].name, "mapped: footprint > 0.5 m");
}

struct ForGis : test::InScratch {
  ForGis() : maps_(write_geotiffs(scratch.folder(), run_)) {
    files_ = write_gis(scratch.folder(), maps_, {.run = run_});
  }
  const talus::Run run_ = small_run();
  std::vector<fs::path> maps_, files_;
};

TEST_F(ForGis, writes_the_ground_before_the_failure_and_a_style_beside_every_map) {
  for (const auto& map : maps_) {
    auto style = map;
    EXPECT_TRUE(fs::exists(style.replace_extension(".qml"))) << style;
  }
  for (const auto& file : files_) EXPECT_TRUE(fs::exists(file)) << file;
  const auto terrain = read_raster(scratch / "terrain.tif");
  const auto& before = run_.maps.before;
  for (std::size_t i = 0; i < before.size(); ++i)
    ASSERT_TRUE(terrain.values[i] == before[i] || (std::isnan(terrain.values[i]) && std::isnan(before[i])));
}

TEST_F(ForGis, names_in_the_project_only_files_that_are_there) {
  const auto text = test::text_of(scratch / "small.qgs");
  ASSERT_FALSE(text.empty());
  std::size_t found = 0;
  const std::string mark = "<datasource>./";
  for (auto place = text.find(mark); place != std::string::npos; place = text.find(mark, place + 1)) {
    const auto begin = place + mark.size();
    EXPECT_TRUE(fs::exists(scratch / text.substr(begin, text.find_first_of("|<", begin) - begin)));
    ++found;
  }
  EXPECT_EQ(found, 11U) << "five outlines, five maps, the terrain";
}

TEST_F(ForGis, writes_outlines_that_ogrinfo_finds_valid) {
  TALUS_NEED_TOOL("/usr/bin/python3 -c 'from osgeo import ogr'", "python3-gdal");
  const auto said = test::output_of("/usr/bin/python3 -c \"from osgeo import ogr; d = ogr.Open('" +
                                    (scratch / "outlines.gpkg").string() +
                                    "'); print([(l.GetName(), all(f.GetGeometryRef().IsValid() for f in l), "
                                    "round(sum(f['area_m2'] for f in l))) for l in d])\" 2>/dev/null");
  // The block of 32 x 10 cells of 3 m, cut off at 0.1 m: 29 thirtieths of a cell further than its outermost centres.
  const double more = 10 * 2.9 / 3, side = 310 + 2 * more, other = 90 + 2 * more, corners = 2 * more * more;
  EXPECT_TRUE(holds(said, {fmt::format("('footprint', True, {:.0f})", side * other - corners)}));
  EXPECT_FALSE(holds(said, {"False"}));
}

/// A run on a plane that falls 3 m over 4 m to the east: the cosine of its slope is 0.8 to the last digits. Its two
/// southernmost rows have no ground.
Run on_a_plane() {
  auto run = test::small_run();
  test::tilt(run.maps, 2);
  return run;
}

TEST(AvaFrame, takes_thickness_normal_to_the_slope_with_its_true_volume) {
  const auto run = on_a_plane();
  const auto normal = normal_thickness(run.maps, run.maps.peak_thickness);
  const auto& grid = run.maps.grid;
  for (int row = 10; row < 20; ++row)
    for (int column = 3; column < 35; ++column)
      ASSERT_NEAR(normal[grid.index(column, row)], 3 * 0.8, 1e-12)
          << column << " " << row << ": rounding of a square root";
  double volume = 0;
  const double slope_area = 100 / 0.8;  // of a cell [m2]
  for (const double h : normal_thickness(run.maps, run.maps.initial_thickness)) volume += h * slope_area;
  EXPECT_NEAR(volume, 24000, 1e-6);
}

TEST(AvaFrame, takes_names_apart_at_underscores) {
  auto run = on_a_plane();
  run.summary.scene = "upper_slide no. 2";
  const std::regex form("rel([^_]+)_([0-9a-f]{10})_C_([SML])_(null|ent)_mpm");
  std::smatch part;
  const auto name = avaframe_name(run, "settings");
  ASSERT_TRUE(std::regex_match(name, part, form)) << name;
  EXPECT_EQ(part[1], "upper-slide-no.-2");
  EXPECT_EQ(part[3], "S") << "24 000 m3";
  EXPECT_EQ(part[4], "null");
  run.summary.volume_released = 50e3;
  run.maps.eroded_depth = run.maps.peak_thickness;
  EXPECT_TRUE(avaframe_name(run, "settings").ends_with("_C_M_ent_mpm"));
  run.summary.volume_released = 60e3;
  EXPECT_TRUE(avaframe_name(run, "settings").ends_with("_C_L_ent_mpm"));
}

TEST(AvaFrame, hashes_the_settings_and_nothing_of_the_machine) {
  const test::Scratch scratch;
  auto run = on_a_plane();
  run.summary.provenance = {{"command", "a"},
                            {"hardware", "b"},
                            {"version", "c"},
                            {"grid", "40 x 30"},
                            {"input dem.tif", "/here/dem.tif sha256 0123"}};
  scratch.write("solve.used.toml", "# wall_time_s: 3\n[solve]\ncfl = 0.5\n");
  const auto settings = settings_text(run, scratch / "run.h5");
  EXPECT_EQ(settings, "[solve]\ncfl = 0.5\ngrid = 40 x 30\ninput dem.tif = sha256 0123\n");
  scratch.write("solve.used.toml", "# wall_time_s: 4\n[solve]\ncfl = 0.5\n");
  run.summary.provenance[0].second = "elsewhere";
  run.summary.provenance[4].second = "/there/dem.tif sha256 0123";
  EXPECT_EQ(settings_text(run, scratch / "run.h5"), settings);
  scratch.write("solve.used.toml", "[solve]\ncfl = 0.4\n");
  EXPECT_NE(avaframe_name(run, settings_text(run, scratch / "run.h5")), avaframe_name(run, settings));
}

class AvaFrameFiles : public ::testing::TestWithParam<AvaFrameFormat> {};

TEST_P(AvaFrameFiles, hold_kilopascals_metres_and_metres_a_second) {
  const test::Scratch scratch;
  const auto run = on_a_plane();
  const auto files = write_avaframe(scratch.folder(), run, "cfl = 0.5\n", GetParam());
  ASSERT_EQ(files.size(), 4U);
  const char* ends[] = {"_ppr", "_pft", "_pfv"};
  const double inside[] = {880, 2.4, 20};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(files[i].stem().string().ends_with(ends[i])) << files[i];
    const auto raster = read_raster(files[i]);
    EXPECT_EQ(raster.grid.west, run.maps.grid.west);
    EXPECT_EQ(raster.grid.south, run.maps.grid.south);
    EXPECT_EQ(raster.grid.cell, run.maps.grid.cell);
    EXPECT_NEAR(raster.at(20, 15), inside[i], 1e-4) << "four decimals in text";
    EXPECT_EQ(raster.at(20, 25), 0) << "never reached";
    EXPECT_TRUE(std::isnan(raster.at(20, 1))) << "outside the domain";
  }
  EXPECT_EQ(test::text_of(files[3]), "cfl = 0.5\n");
  EXPECT_EQ(files[3].stem().string() + "_ppr", files[0].stem().string());
}

INSTANTIATE_TEST_SUITE_P(BothFormats, AvaFrameFiles, ::testing::Values(AvaFrameFormat::tif, AvaFrameFormat::asc),
                         [](const auto& format) { return format.param == AvaFrameFormat::tif ? "tif" : "asc"; });

TEST(AvaFrame, says_the_volume_both_ways) {
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  const test::Scratch scratch;
  const auto files = write_avaframe(scratch.folder(), on_a_plane(), "", AvaFrameFormat::tif);
  EXPECT_TRUE(holds(test::output_of("gdalinfo '" + files[1].string() + "'"),
                    {"RELEASE_VOLUME_M3=24000", "RELEASE_VOLUME_IF_NORMAL_WERE_VERTICAL_M3=19200",
                     "THICKNESS_CONVENTION=normal to the slope", "Unit Type: m"}));
}

}  // namespace
}  // namespace talus::postprocess
