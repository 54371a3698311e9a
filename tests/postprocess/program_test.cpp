// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage as a whole: recipe and run.h5 in, results out.
#include <nlohmann/json.hpp>

#include "common/gis/geotiff.hpp"
#include "common/gis/raster_file.hpp"
#include "tests/common/geojson.hpp"
#include "tests/postprocess/stage_run.hpp"

namespace fs = std::filesystem;

namespace talus::postprocess {
namespace {

using test::holds;

struct Program : test::StageRun {
  Program() { recipe_ = "[scene]\nname = \"small\"\n"; }
  nlohmann::json score() const { return nlohmann::json::parse(test::text_of(out_ / "score.json")); }
};

TEST_F(Program, scores_against_a_thickness_raster_named_in_the_recipe) {
  const auto run = test::small_run();
  test::write_run(out_ / "run.h5", run);
  write_geotiff(scratch / "survey.tif", {run.maps.grid, run.maps.deposit_thickness}, {"", "m", {}});
  recipe_ += "[postprocess.survey]\nthickness = \"survey.tif\"\n";
  run_it();
  EXPECT_EQ(score().at("deposit_csi"), 1);
  EXPECT_FALSE(score().contains("footprint_csi"));
}

TEST_F(Program, writes_aliases_for_avaframe_where_they_are_asked_for) {
  test::write_run(out_ / "run.h5", test::small_run());
  run_it();
  EXPECT_FALSE(fs::exists(out_ / "maps/avaframe"));
  recipe_ += "[postprocess]\noutputs = [\"avaframe-asc\"]\n";
  run_it();
  EXPECT_EQ(std::distance(fs::directory_iterator(out_ / "maps/avaframe"), {}), 4);
  const auto is_alias = [](const fs::path& file) { return file.string().ends_with("_C_S_null_mpm_pft.asc"); };
  EXPECT_EQ(std::count_if(results_.begin(), results_.end(), is_alias), 1) << "not announced";
}

TEST_F(Program, writes_every_result_and_names_it_unless_only_checking) {
  test::write_run(out_ / "run.h5", test::small_run());
  run_it(true);
  EXPECT_EQ(std::distance(fs::directory_iterator(out_), {}), 1) << "run.h5 alone";
  run_it();
  expect_results({"maps/deposit_thickness.tif", "maps/peak_thickness.tif", "maps/peak_speed.tif",
                  "maps/peak_pressure.tif", "maps/arrival_time.tif", "maps/results.nc", "maps/deposit_thickness.qml",
                  "maps/peak_pressure.qml", "maps/terrain.tif", "maps/terrain.qml", "maps/outlines.gpkg",
                  "maps/small.qgs", "map.png", "report.html", "history.csv", "score.json", "score.txt"});
  EXPECT_TRUE(fs::exists(out_ / "postprocess.used.toml"));
  for (const auto& entry : fs::recursive_directory_iterator(out_))
    EXPECT_FALSE(holds(entry.path().string(), {".partial"})) << entry.path();
}

TEST_F(Program, reads_the_run_named_in_the_recipe) {
  test::write_run(scratch / "elsewhere.h5", test::small_run());
  recipe_ += "[postprocess]\nrun = \"elsewhere.h5\"\n";
  run_it();
  EXPECT_EQ(score().at("title"), "Small slope");
}

TEST_F(Program, refuses_a_missing_and_a_truncated_run_and_a_map_whose_volume_is_not_that_of_the_points) {
  EXPECT_TRUE(holds(fault(), {"run.h5: no such file. Run talus-solve"}));
  test::write_run(out_ / "run.h5", test::small_run());
  fs::resize_file(out_ / "run.h5", fs::file_size(out_ / "run.h5") / 2);
  EXPECT_TRUE(holds(fault(), {"run.h5: is damaged (its checksum is missing", "Run talus-solve again"}));
  EXPECT_FALSE(fs::exists(out_ / "maps"));
  auto run = test::small_run();
  run.summary.volume_final *= 1.05;
  test::write_run(out_ / "run.h5", run);
  EXPECT_TRUE(holds(fault(), {"24000 m3 under the deposit map, 25200 m3 in the points"}));
}

TEST_F(Program, refuses_a_survey_that_does_not_overlap_before_writing_anything) {
  const auto run = test::small_run();
  test::write_run(out_ / "run.h5", run);
  auto grid = run.maps.grid;
  grid.south += 9000;
  write_geotiff(scratch / "survey.tif", {grid, run.maps.deposit_thickness}, {"", "m", {}});
  recipe_ += "[postprocess.survey]\nthickness = \"survey.tif\"\n";
  EXPECT_TRUE(holds(fault(), {"no surveyed cell lies in the run's area"}));
  EXPECT_FALSE(fs::exists(out_ / "maps"));
}

TEST_F(Program, reports_all_faults_of_its_table_at_once) {
  recipe_ +=
      "[postprocess]\nclasses_m = [5.0, 1.0]\n[postprocess.survey]\nthickness = \"a.tif\"\nafter_dem = "
      "\"b.tif\"\npolygon = \"c.gpkg\"\n"
      "peak_thickness = \"d.tif\"\nsigma = \"e.tif\"\nsigma_m = 0.3\n";
  EXPECT_TRUE(
      holds(test::fault_of<RecipeError>([&] { run_it(); }),
            {"classes_m does not rise", "thickness and after_dem", "peak_thickness and polygon", "sigma and sigma_m"}));
}

TEST_F(Program, refuses_an_error_of_nothing_measured) {
  recipe_ += "[postprocess.survey]\npolygon = \"c.gpkg\"\nsigma_m = 0.3\n";
  EXPECT_TRUE(holds(test::fault_of<RecipeError>([&] { run_it(); }), {"gives an error without a measurement"}));
}

TEST_F(Program, scores_with_the_surveys_error_along_a_line_named_in_the_recipe) {
  const auto run = test::small_run();
  test::write_run(out_ / "run.h5", run);
  auto change = run.maps.deposit_thickness;
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= run.maps.initial_thickness[i];
  write_geotiff(scratch / "difference.tif", {run.maps.grid, change}, {"", "m", {}});
  write_geotiff(scratch / "sigma.tif", {run.maps.grid, std::vector<double>(change.size(), 0.4)},
                {"", "m", {{"CORRELATION_LENGTH_M", "50"}}});
  scratch.write("line.geojson",
                test::geojson(test::feature("LineString", "[[600390,5100150],[600010,5100150]]"), 32632));
  recipe_ +=
      "[postprocess]\nthalweg = \"line.geojson\"\n[postprocess.survey]\ndifference = \"difference.tif\"\nsigma = "
      "\"sigma.tif\"\n";
  run_it();
  EXPECT_EQ(score().at("deposit_csi"), 1);
  EXPECT_EQ(score().at("residual_chi2"), 0);
  EXPECT_EQ(score().at("resamples"), 200);
  EXPECT_EQ(score().at("survey_correlation_length_m"), 50);
  EXPECT_GT(score().at("deposit_csi_sd"), 0);
  EXPECT_LT(score().at("deposit_csi_p05"), score().at("deposit_csi_p95"));
  EXPECT_GT(score().at("footprint_csi_sd"), 0);
  EXPECT_EQ(score().at("thalweg"), "line of line.geojson");
  EXPECT_EQ(score().at("thalweg_runout_m"), 310) << "columns 3 to 34";
  EXPECT_TRUE(holds(test::text_of(out_ / "postprocess.used.toml"), {"line.geojson", "difference.tif", "sigma.tif"}));
}

TEST_F(Program, prints_a_template_that_it_accepts) {
  const auto text = stage().template_toml();
  EXPECT_TRUE(holds(text, {"# deposit_threshold_m = ...", "friction_is = \"not-said\"", "[postprocess.survey]"}));
  recipe_ += text;
  test::write_run(out_ / "run.h5", test::small_run());
  EXPECT_NO_THROW(run_it(true)) << text;
}

}  // namespace
}  // namespace talus::postprocess
