// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The survey on disk and the one grid both sides are compared on.
#include "postprocess/survey/survey.hpp"

#include <random>

#include "common/gis/crs.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/raster_file.hpp"

#include "postprocess/fields/fields.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/geojson.hpp"
#include "tests/common/heights.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::holds;
using test::small_grid;
using test::small_run;

/// A square of side 4 with a hole of side 2, as GeoJSON in the run's coordinates.
std::string square_with_hole(double x, double y, double size) {
  const auto ring = [&](double inset) {
    const double a = x + inset, b = y + inset, c = x + size - inset, d = y + size - inset;
    std::string text = "[";
    for (const auto& [px, py] : {std::pair{a, b}, {c, b}, {c, d}, {a, d}, {a, b}})
      text += "[" + std::to_string(px) + "," + std::to_string(py) + "],";
    text.back() = ']';
    return text;
  };
  return test::geojson(test::feature("Polygon", "[" + ring(0) + "," + ring(0.25 * size) + "]"), 32632);
}

struct SurveyTest : test::InScratch {
  std::filesystem::path raster(const std::string& name, const MapGrid& grid, const std::vector<double>& values) {
    write_geotiff(scratch / name, {grid, values}, {name, "m", {}});
    return scratch / name;
  }
  std::filesystem::path everywhere(const std::string& name, const MapGrid& grid, double value) {
    return raster(name, grid, std::vector<double>(grid.count(), value));
  }
  std::optional<Survey> read(const DeclaredHeights& ground = {}) const {
    return read_survey(options_, run_.maps, 1.0, ground);
  }
  std::string fault() const {
    return data_fault([&] { read(); });
  }
  talus::Run run_ = small_run();
  SurveyOptions options_;
};

TEST_F(SurveyTest, is_empty_when_nothing_is_given) { EXPECT_FALSE(read()); }

TEST_F(SurveyTest, compares_on_the_surveys_own_grid_and_keeps_the_volume) {
  // Coarser, shifted by a part of a cell, covering the whole run.
  const MapGrid grid{.columns = 20, .rows = 16, .west = 599993, .south = 5099991, .cell = 25, .crs_wkt = test::utm32n};
  options_.thickness = everywhere("survey.tif", grid, 2.0);
  const auto survey = read();
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->grid.columns, 20);
  const auto simulated = bring_to_survey_grid(run_.maps, *survey);
  EXPECT_NEAR(volume_under(simulated.deposit, 25), run_.summary.volume_final, 1e-9 * run_.summary.volume_final);
  EXPECT_EQ(simulated.deposit_left_out, 0);
}

TEST_F(SurveyTest, leaves_out_what_was_not_surveyed_and_says_how_much) {
  auto values = block(small_grid(), 0, 40, 0, 30, 0.5);
  for (int row = 0; row < 30; ++row)
    for (int column = 30; column < 40; ++column) values[small_grid().index(column, row)] = nan;
  options_.thickness = raster("survey.tif", small_grid(), values);
  const auto survey = read();
  const auto simulated = bring_to_survey_grid(run_.maps, *survey);
  EXPECT_DOUBLE_EQ(simulated.deposit_left_out,
                   (5 * 10 * 1.5 + 6 * 5.0) * 100);  // columns 30-34, and the core's column 30
  EXPECT_TRUE(std::isnan(simulated.deposit[small_grid().index(32, 15)]));
}

TEST_F(SurveyTest, brings_thickness_normal_to_the_slope_to_the_vertical) {
  auto& grid = run_.maps.grid;
  test::tilt(run_.maps);
  options_.thickness = everywhere("normal.tif", grid, 2.0);
  options_.direction = Direction::slope_normal;
  const auto survey = read();
  ASSERT_TRUE(survey);
  for (const double value : survey->deposit) EXPECT_NEAR(value, 2.5, 1e-6);  // 3 : 4 : 5
}

TEST_F(SurveyTest, takes_the_rise_of_the_surface_from_two_dems) {
  auto after = run_.maps.before;
  const auto& grid = run_.maps.grid;
  for (std::size_t i = 0; i < after.size(); ++i)
    after[i] += run_.maps.deposit_thickness[i] - run_.maps.initial_thickness[i];
  // Part of the slide stays in its own scar: the surface there still falls.
  const auto scar = grid.index(4, 15);
  run_.maps.deposit_thickness[scar] = 2;
  after[scar] += 2;
  options_.after_dem = raster("after.tif", grid, after);
  options_.before_dem = raster("before.tif", grid, run_.maps.before);
  const auto survey = read();
  ASSERT_TRUE(survey && survey->deposit_is_change);
  EXPECT_EQ(survey->deposit[scar], 0) << "lowered by 4 m: no deposit";
  EXPECT_NEAR(survey->footprint[scar], 4, 1e-9);
  const auto simulated = bring_to_survey_grid(run_.maps, *survey);
  EXPECT_EQ(simulated.deposit[scar], 0) << "the simulated surface fell there too";
  const auto deposit = grid.index(29, 15);
  EXPECT_NEAR(survey->deposit[deposit], 6.5, 1e-9);
  EXPECT_NEAR(simulated.deposit[deposit], 6.5, 1e-9);
}

TEST_F(SurveyTest, takes_the_runs_own_surface_when_only_the_after_dem_is_given) {
  auto after = run_.maps.before;
  for (double& z : after) z += 3;
  options_.after_dem = raster("after.tif", run_.maps.grid, after);
  const auto survey = read();
  EXPECT_NEAR(survey->deposit[run_.maps.grid.index(20, 20)], 3, 1e-9);
  EXPECT_TRUE(std::isnan(survey->deposit[0])) << "outside the run's domain nothing is known";
}

/// A difference: up by 0.4 and 3 m, down by 5 m, unchanged elsewhere.
std::vector<double> some_change() {
  std::vector<double> change(small_grid().count(), 0.0);
  change[small_grid().index(10, 10)] = 0.4;
  change[small_grid().index(20, 10)] = 3;
  change[small_grid().index(5, 10)] = -5;
  return change;
}

TEST_F(SurveyTest, takes_a_difference_as_rise_and_fall_and_compares_it_with_the_change) {
  options_.difference = raster("difference.tif", small_grid(), some_change());
  const auto survey = read();
  ASSERT_TRUE(survey && survey->deposit_is_change && survey->footprint_is_change);
  EXPECT_EQ(survey->deposit[small_grid().index(10, 10)], 0.4) << "no level of detection without a sigma";
  EXPECT_EQ(survey->deposit[small_grid().index(20, 10)], 3);
  EXPECT_EQ(survey->deposit[small_grid().index(5, 10)], 0);
  EXPECT_EQ(survey->footprint[small_grid().index(5, 10)], 5);
  EXPECT_TRUE(survey->error.sigma.empty());
  const auto simulated = bring_to_survey_grid(run_.maps, *survey);
  EXPECT_EQ(simulated.change[small_grid().index(4, 15)], -6) << "the scar";
  EXPECT_EQ(simulated.deposit[small_grid().index(4, 15)], 0);
  EXPECT_EQ(simulated.change[small_grid().index(26, 15)], 1.5);
}

TEST_F(SurveyTest, counts_what_lies_below_the_level_of_detection_as_no_change) {
  options_.difference = raster("difference.tif", small_grid(), some_change());
  options_.sigma_m = 0.25;  // a level of 0.49 m
  options_.correlation_length = 60;
  auto survey = read();
  EXPECT_EQ(survey->deposit[small_grid().index(10, 10)], 0);
  EXPECT_EQ(survey->footprint[small_grid().index(10, 10)], 0);
  EXPECT_EQ(survey->measured[small_grid().index(10, 10)], 0.4) << "what was measured is kept for the residuals";
  EXPECT_EQ(survey->deposit[small_grid().index(20, 10)], 3);
  EXPECT_TRUE(survey->notes.empty());
  survey->error.detection = 0;
  EXPECT_EQ(detected(*survey, survey->measured).deposit[small_grid().index(10, 10)], 0.4);
}

TEST_F(SurveyTest, brings_sigma_to_its_grid_with_the_range_its_file_names) {
  const MapGrid coarse{
      .columns = 20, .rows = 15, .west = 600000, .south = 5100000, .cell = 20, .crs_wkt = test::utm32n};
  write_geotiff(scratch / "sigma.tif", {coarse, std::vector<double>(coarse.count(), 0.3)},
                {"sigma", "m", {{"CORRELATION_LENGTH_M", "45.5"}}});
  options_.difference = raster("difference.tif", small_grid(), some_change());
  options_.sigma = scratch / "sigma.tif";
  auto survey = read();
  ASSERT_EQ(survey->error.sigma.size(), small_grid().count());
  EXPECT_NEAR(survey->error.sigma[small_grid().index(13, 7)], 0.3, 1e-12);
  EXPECT_EQ(survey->error.correlation_length, 45.5);
  EXPECT_EQ(survey->inputs.size(), 2u);
  options_.correlation_length = 80;
  EXPECT_EQ(read()->error.correlation_length, 80) << "the recipe goes first";
}

TEST_F(SurveyTest, warns_where_the_range_of_its_errors_is_not_known) {
  options_.difference = raster("difference.tif", small_grid(), some_change());
  options_.sigma_m = 0.25;
  const auto found = [&] { return test::findings_of([&] { EXPECT_EQ(read()->error.correlation_length, 0); }); };
  ASSERT_EQ(found().size(), 1u);
  EXPECT_EQ(found()[0].name, "unknown-correlation-length");
  EXPECT_TRUE(holds(found()[0].message, {"Give correlation_length_m"}));
}

TEST_F(SurveyTest, leaves_out_what_was_measured_without_a_sigma) {
  options_.difference = raster("difference.tif", small_grid(), some_change());
  auto sigma = std::vector<double>(small_grid().count(), 0.1);
  sigma[small_grid().index(20, 10)] = sigma[small_grid().index(30, 20)] = nan;
  options_.sigma = raster("sigma.tif", small_grid(), sigma);
  options_.correlation_length = 60;
  const auto survey = read();
  EXPECT_TRUE(std::isnan(survey->deposit[small_grid().index(20, 10)]));
  EXPECT_EQ(survey->deposit[small_grid().index(30, 20)], 0) << "mapped as untouched: needs none";
  EXPECT_EQ(survey->notes, std::vector<std::string>{"1 surveyed cells without a sigma are left out."});
  sigma[3] = -0.1;
  options_.sigma = raster("negative.tif", small_grid(), sigma);
  EXPECT_TRUE(holds(fault(), {"negative.tif: a standard error of -0.1 m (it cannot be negative)"}));
}

TEST_F(SurveyTest, brings_dems_in_degrees_to_the_runs_crs) {
  const auto& run = run_.maps.grid;
  MapGrid degrees{0, 0, 0, 0, 0.0001, crs_by_name("EPSG:4326")};
  const Extent e = transform_extent({run.west, run.south, run.east(), run.north()}, run.crs_wkt, degrees.crs_wkt);
  degrees.west = e.west - 0.001;
  degrees.south = e.south - 0.001;
  degrees.columns = static_cast<int>((e.east - e.west) / degrees.cell) + 20;
  degrees.rows = static_cast<int>((e.north - e.south) / degrees.cell) + 20;
  options_.before_dem = everywhere("before.tif", degrees, 1000);
  options_.after_dem = everywhere("after.tif", degrees, 1003);
  const auto survey = read();
  EXPECT_TRUE(same_crs(survey->grid.crs_wkt, run.crs_wkt));
  EXPECT_NEAR(survey->grid.cell, 9.3, 0.06);  // of 7.7 x 11.1 m
  EXPECT_NEAR(survey->deposit[survey->grid.index(survey->grid.columns / 2, survey->grid.rows / 2)], 3, 1e-9);
}

TEST_F(SurveyTest, compares_the_vertical_datums_of_both_surfaces) {
  const auto level = [&](const char* name, double height, const char* crs) {
    const MapGrid& grid = run_.maps.grid;
    return test::write_in_crs(scratch, name, {grid, std::vector<double>(grid.count(), height)}, crs);
  };
  const auto of = [](const std::filesystem::path& file) { return RasterFile(file).heights(); };
  options_.before_dem = level("before", 1000, "EPSG:32632+3855");
  options_.after_dem = level("after", 1003, "EPSG:32632+5773");
  EXPECT_TRUE(holds(fault(), {"./after.vrt", "EGM96 geoid", "./before.vrt", "EGM2008 geoid"}));
  const DeclaredHeights same = of(options_.after_dem), other = of(options_.before_dem);
  options_.before_dem.clear();
  EXPECT_TRUE(read(same));
  EXPECT_TRUE(holds(data_fault([&] { read(other); }), {"EGM96 geoid", "EGM2008 geoid"}));
}

TEST_F(SurveyTest, fills_polygons_and_leaves_their_holes) {
  options_.polygon = scratch.write("outline.geojson", square_with_hole(600000, 5100100, 40));
  const auto survey = read();
  ASSERT_TRUE(survey);
  EXPECT_TRUE(survey->deposit.empty());
  EXPECT_EQ(std::count(survey->footprint.begin(), survey->footprint.end(), 1.0), 16 - 4);
  EXPECT_EQ(survey->footprint[small_grid().index(0, 10)], 1);
  EXPECT_EQ(survey->footprint[small_grid().index(1, 11)], 0) << "in the hole";
  EXPECT_EQ(survey->footprint[small_grid().index(4, 10)], 0);
}

TEST_F(SurveyTest, refuses_a_survey_elsewhere_in_another_crs_or_missing) {
  auto grid = small_grid();
  grid.west += 50000;
  options_.thickness = everywhere("elsewhere.tif", grid, 1.0);
  EXPECT_TRUE(holds(fault(), {"elsewhere.tif: no surveyed cell lies in the run's area (survey x 650000.0 to"}));
  options_ = {};
  options_.polygon = scratch.write("outline.geojson", square_with_hole(650000, 5100100, 40));
  EXPECT_TRUE(holds(fault(), {"no polygon covers a cell of the run's area"}));
  options_ = {};
  grid = small_grid();
  grid.crs_wkt.clear();
  options_.thickness = everywhere("bare.tif", grid, 1.0);
  EXPECT_TRUE(holds(fault(), {"bare.tif: CRS is local metric coordinates (the run is in EPSG:32632)",
                              "gdal_edit.py -a_srs EPSG:32632"}));
  options_.thickness = scratch / "nowhere.tif";
  EXPECT_TRUE(holds(fault(), {"nowhere.tif: no such file"}));
}

TEST_F(SurveyTest, finds_what_preprocess_left_or_says_what_is_missing) {
  options_.from_preprocess = true;
  EXPECT_THROW(options_.find_in(scratch / "out"), DataError);
  std::filesystem::create_directories(scratch / "out" / "survey");
  for (const char* name : {"slide_difference.tif", "difference_sigma.tif"})
    std::filesystem::copy_file(raster(name, small_grid(), some_change()), scratch / "out" / "survey" / name);
  options_.find_in(scratch / "out");
  EXPECT_EQ(options_.difference, scratch / "out" / "survey" / "slide_difference.tif");
  EXPECT_EQ(options_.sigma, scratch / "out" / "survey" / "difference_sigma.tif");
}

TEST_F(SurveyTest, takes_no_error_of_zero_for_a_known_one) {
  options_.difference = raster("change.tif", small_grid(), some_change());
  std::vector<double> sigma(small_grid().count(), 0.0);
  options_.sigma = raster("zero.tif", small_grid(), sigma);
  EXPECT_TRUE(holds(fault(), {"zero.tif: a standard error of 0 m everywhere"}));
  const auto changed = some_change();
  const auto cell = static_cast<std::size_t>(
      std::find_if(changed.begin(), changed.end(), [](double change) { return change != 0; }) - changed.begin());
  std::fill(sigma.begin(), sigma.end(), 0.3);
  sigma[cell] = 0;
  options_.sigma = raster("one.tif", small_grid(), sigma);
  EXPECT_TRUE(std::isnan(read()->measured[cell]));
}

TEST_F(SurveyTest, without_a_known_error_wants_no_raster_of_it) {
  options_.from_preprocess = true;
  std::filesystem::create_directories(scratch / "out" / "survey");
  std::filesystem::copy_file(raster("slide_difference.tif", small_grid(), some_change()),
                             scratch / "out" / "survey" / "slide_difference.tif");
  EXPECT_THROW(options_.find_in(scratch / "out"), DataError);
  options_.find_in(scratch / "out", false);
  EXPECT_TRUE(options_.sigma.empty());
}

TEST_F(SurveyTest, refuses_to_score_when_much_changed_outside_the_slide) {
  const auto out = scratch / "out";
  std::filesystem::create_directories(out / "survey");
  EXPECT_FALSE(read_found_survey(out).outside_is_large) << "no survey.json";
  std::ofstream(out / "survey" / "survey.json")
      << R"({"error": {"known": false}, "outside_slide": {"large": true, "words": "9,059 m3 rose"},)"
      << R"("id": "d1", "recipe": "5e"})";
  const FoundSurvey found = read_found_survey(out);
  EXPECT_FALSE(found.error_known);
  EXPECT_TRUE(lacks_error(out));
  EXPECT_EQ(found.id, "d1");
  EXPECT_EQ(found.recipe_mark, "5e");
  const auto judged = [&](std::vector<std::string> accept) {
    return test::findings_of([&] { judge_outside(found, out); }, std::move(accept), "postprocess");
  };
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { judged({}); }),
                    {"9,059 m3 rose", "accept = [\"change-outside-slide\"] in [postprocess]"}));
  EXPECT_TRUE(is_accepted(judged({"change-outside-slide"}), "change-outside-slide"));
  std::ofstream(out / "survey" / "survey.json") << "{\"error\": ";
  EXPECT_THROW(read_found_survey(out), DataError);
}

/// A change with `noise` everywhere, and a slide of 2.4 m where the run has its deposit.
std::vector<double> noisy_change(const RunMaps& maps, double noise) {
  std::vector<double> change = block(maps.grid, 25, 35, 10, 20, 2.4);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] += noise * std::sin(1.7 * static_cast<double>(i));
  return change;
}

TEST_F(SurveyTest, counts_no_noise_as_change_where_the_error_is_not_given) {
  for (const double noise : {0.0, 0.05, 0.2}) {
    options_.difference = raster("difference.tif", small_grid(), noisy_change(run_.maps, noise));
    const auto survey = read_survey(options_, run_.maps, 0.1, {});
    EXPECT_GE(survey->error.noise, noise) << noise;
    EXPECT_LE(survey->error.noise, 1) << noise;
    EXPECT_EQ(survey->usual_level(), survey->error.noise);
    const auto above =
        std::count_if(survey->footprint.begin(), survey->footprint.end(), [](double v) { return v > 0.1; });
    EXPECT_EQ(above, 100) << noise;
  }
  options_.difference = raster("difference.tif", small_grid(), noisy_change(run_.maps, 5));
  EXPECT_EQ(read_survey(options_, run_.maps, 0.1, {})->error.noise, 1) << "as large as slides: no noise";
}

TEST_F(SurveyTest, takes_negative_thickness_for_noise) {
  const auto noise_of_thickness = [&](std::vector<double> thickness) {
    options_.thickness = raster("thickness.tif", small_grid(), std::move(thickness));
    return read()->error.noise;
  };
  std::mt19937 random(3);
  std::normal_distribution<double> error(0, 0.1);
  std::vector<double> noisy = block(small_grid(), 25, 35, 10, 20, 2.4), clipped;
  for (double& value : noisy) value += error(random);
  for (const double value : noisy) clipped.push_back(std::max(0.0, value));
  EXPECT_NEAR(noise_of_thickness(noisy), 0.5, 0.05);
  EXPECT_EQ(noise_of_thickness(clipped), 0);
  EXPECT_EQ(noise_of_thickness(std::vector<double>(small_grid().count(), 2.0)), 0) << "a deposit that the run lacks";
}

TEST_F(SurveyTest, leaves_out_of_the_simulation_what_the_survey_could_not_detect) {
  options_.difference = raster("difference.tif", small_grid(), noisy_change(run_.maps, 0));
  options_.sigma_m = 0.5;
  run_.maps.deposit_thickness[0] = run_.maps.peak_thickness[0] = 0.9;
  run_.maps.deposit_thickness[1] = run_.maps.peak_thickness[1] = 1.0;
  const auto survey = read_survey(options_, run_.maps, 0.1, {});
  EXPECT_EQ(survey->usual_level(), 0.98);
  const auto simulated = bring_to_survey_grid(run_.maps, *survey);
  EXPECT_EQ(simulated.deposit[0], 0);
  EXPECT_EQ(simulated.peak[0], 0);
  EXPECT_EQ(simulated.deposit[1], 1.0);
  EXPECT_EQ(simulated.peak[1], 1.0);
}

TEST_F(SurveyTest, counts_a_wider_cell_where_most_of_it_is_covered) {
  auto grid = small_grid();
  grid.columns /= 2;
  grid.rows /= 2;
  grid.cell *= 2;
  options_.thickness = everywhere("survey.tif", grid, 1.0);
  auto& maps = run_.maps;
  maps.deposit_thickness.assign(maps.grid.count(), 0.0);
  const int cells[][2] = {{0, 0}, {2, 0}, {3, 0}, {2, 1}};  // one of the four of a cell, three of the next one
  for (const auto& [column, row] : cells) maps.deposit_thickness[maps.grid.index(column, row)] = 3;
  maps.peak_thickness = maps.deposit_thickness;
  const auto simulated = bring_to_survey_grid(maps, *read());
  EXPECT_EQ(simulated.deposit[0], 0.75) << "the volume is kept";
  EXPECT_EQ(simulated.covered[0], 0.25);
  EXPECT_EQ(simulated.touched[1], 0.75);
}

/// The small slope falls to the east.
TEST_F(SurveyTest, refuses_a_change_that_carries_mass_uphill) {
  const talus::Run run = small_run();
  Survey survey;
  survey.grid = run.maps.grid;
  survey.deposit_is_change = true;
  survey.footprint_threshold = 1;
  survey.measured = block(survey.grid, 3, 7, 10, 20, -6.0);
  const auto risen = block(survey.grid, 25, 35, 10, 20, 2.4);
  for (std::size_t i = 0; i < risen.size(); ++i) survey.measured[i] += risen[i];
  const auto judged = [&](std::vector<std::string> accept) {
    return test::findings_of([&] { judge_order(survey, run.maps); }, std::move(accept), "postprocess");
  };
  EXPECT_TRUE(judged({}).empty());
  for (double& change : survey.measured) change = -change;
  EXPECT_TRUE(
      holds(test::fault_of<DataError>([&] { judged({}); }), {"accept = [\"swapped-surveys\"] in [postprocess]"}));
  EXPECT_TRUE(is_accepted(judged({"swapped-surveys"}), "swapped-surveys"));
  survey.deposit_is_change = false;
  EXPECT_TRUE(judged({}).empty());
}

}  // namespace
}  // namespace talus::postprocess
