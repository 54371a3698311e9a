// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What makes the maps ready for a GIS: styles, outlines at thresholds, the project.
#include "postprocess/maps/gis.hpp"
#include "common/gis/read_raster.hpp"

#include <fmt/format.h>

#include <functional>

#include "postprocess/fields/styles.hpp"
#include "postprocess/maps/geotiff.hpp"
#include "postprocess/writers/job.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

namespace fs = std::filesystem;
using test::small_run;

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

class ForGis : public ::testing::Test {
 protected:
  ForGis() : maps_(write_geotiffs(scratch_.folder(), run_)) {
    files_ = write_gis(scratch_.folder(), maps_, {.run = run_});
  }
  test::Scratch scratch_;
  const talus::Run run_ = small_run();
  std::vector<fs::path> maps_, files_;
};

TEST_F(ForGis, puts_a_style_beside_every_map) {
  for (const auto& map : maps_) {
    auto style = map;
    EXPECT_TRUE(fs::exists(style.replace_extension(".qml"))) << style;
  }
  for (const auto& file : files_) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(ForGis, writes_the_ground_before_the_failure) {
  const auto terrain = read_raster(scratch_ / "terrain.tif");
  const auto& before = run_.maps.before;
  for (std::size_t i = 0; i < before.size(); ++i)
    ASSERT_TRUE(terrain.values[i] == before[i] || (std::isnan(terrain.values[i]) && std::isnan(before[i])));
}

TEST_F(ForGis, names_in_the_project_only_files_that_are_there) {
  const auto text = test::text_of(scratch_ / "small.qgs");
  ASSERT_FALSE(text.empty());
  std::size_t found = 0;
  const std::string mark = "<datasource>./";
  for (auto place = text.find(mark); place != std::string::npos; place = text.find(mark, place + 1)) {
    const auto begin = place + mark.size();
    EXPECT_TRUE(fs::exists(scratch_ / text.substr(begin, text.find_first_of("|<", begin) - begin)));
    ++found;
  }
  EXPECT_EQ(found, 11U) << "five outlines, five maps, the terrain";
}

TEST_F(ForGis, writes_outlines_that_ogrinfo_finds_valid) {
  TALUS_NEED_TOOL("/usr/bin/python3 -c 'from osgeo import ogr'", "python3-gdal");
  const auto said = test::output_of("/usr/bin/python3 -c \"from osgeo import ogr; d = ogr.Open('" +
                                    (scratch_ / "outlines.gpkg").string() +
                                    "'); print([(l.GetName(), all(f.GetGeometryRef().IsValid() for f in l), "
                                    "round(sum(f['area_m2'] for f in l))) for l "
                                    "in d])\" 2>/dev/null");
  // The block of 32 x 10 cells of 3 m, cut off at 1 m: two thirds of a cell further than its outermost centres.
  const double side = 310 + 2 * 10 * 2.0 / 3, other = 90 + 2 * 10 * 2.0 / 3, corners = 2 * (20.0 / 3) * (20.0 / 3);
  EXPECT_TRUE(test::holds(said, {fmt::format("('footprint', True, {:.0f})", side * other - corners)}));
  EXPECT_FALSE(test::holds(said, {"False"}));
}

}  // namespace
}  // namespace talus::postprocess
