#include "postprocess/score/score.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::small_grid;
using test::small_run;

/// The survey of small_run(): the same deposit two columns further and 0.5 m thicker in all its 10 x 10 cells.
Survey shifted_survey() {
  Survey survey;
  survey.name = "made by hand";
  survey.grid = small_grid();
  survey.deposit = block(survey.grid, 27, 37, 10, 20, 2.0);
  survey.footprint = block(survey.grid, 3, 37, 10, 20, 5.0);
  survey.footprint_threshold = 1;
  return survey;
}

nlohmann::json json_of(const Run& run, const std::optional<Survey>& survey) {
  return nlohmann::json::parse(to_json(make_score(run, {}, survey)));
}

TEST(Score, holds_the_runs_numbers_without_a_survey) {
  const auto json = json_of(small_run(), {});
  EXPECT_EQ(json.at("volume_released_m3"), 24000);
  EXPECT_EQ(json.at("volume_outflow_m3"), 0);
  EXPECT_EQ(json.at("volume_closure_error"), 0);
  EXPECT_NEAR(json.at("volume_map_error").get<double>(), 0, 1e-12);
  EXPECT_EQ(json.at("particles"), 320);
  EXPECT_EQ(json.at("steps"), 77);
  EXPECT_EQ(json.at("wall_time_s"), 0.25);
  EXPECT_EQ(json.at("on"), "cpu");
  EXPECT_EQ(json.at("affected_area_m2"), 320 * 100);
  EXPECT_EQ(json.at("max_deposit_thickness_m"), 6.5);
  EXPECT_FALSE(json.contains("deposit_csi"));
  EXPECT_EQ(json.at("not_scored").at("deposit_csi"), "no survey is given");
}

TEST(Score, measures_runout_from_the_crown_to_the_farthest_deposit) {
  const auto run = small_run();
  const auto json = json_of(run, {});
  const double length = json.at("runout_m"), drop = json.at("drop_m");
  EXPECT_NEAR(length, std::hypot(31 * 10.0, 9 * 10.0), 60) << "31 columns, up to 9 rows";
  EXPECT_GE(length, 310);
  EXPECT_NEAR(drop, 31 * 5.0 + 6, 8) << "5 m a column, and the release's own thickness";
  EXPECT_DOUBLE_EQ(json.at("h_over_l").get<double>(), drop / length);
}

TEST(Score, agrees_with_a_survey_made_by_hand) {
  const auto json = json_of(small_run(), shifted_survey());
  EXPECT_DOUBLE_EQ(json.at("deposit_csi").get<double>(), 80.0 / 120);
  EXPECT_DOUBLE_EQ(json.at("footprint_csi").get<double>(), 32.0 / 34);
  EXPECT_DOUBLE_EQ(json.at("deposit_true_positive_m2").get<double>(), 8000);
  EXPECT_DOUBLE_EQ(json.at("deposit_false_positive_m2").get<double>(), 2000);
  EXPECT_DOUBLE_EQ(json.at("deposit_false_negative_m2").get<double>(), 2000);
  EXPECT_DOUBLE_EQ(json.at("deposit_true_negative_m2").get<double>(), (1200 - 120) * 100);
  // 20 cells 1.5 m too thick, 20 cells 2 m too thin, 80 in both: 18 of them 4.5 m too thick, 62 of them 0.5 m too thin.
  EXPECT_NEAR(json.at("thickness_rmse_m").get<double>(),
              std::sqrt((20 * 2.25 + 20 * 4.0 + 18 * 20.25 + 62 * 0.25) / 120), 1e-12);
  EXPECT_NEAR(json.at("thickness_bias_m").get<double>(), (20 * 1.5 - 20 * 2.0 + 18 * 4.5 - 62 * 0.5) / 120, 1e-12);
  EXPECT_NEAR(json.at("deposit_volume_ratio").get<double>(), 24000.0 / 20000, 1e-12);
  EXPECT_NEAR(json.at("runout_difference_m").get<double>(), -20, 1.0) << "two columns short";
  EXPECT_TRUE(json.at("not_scored").empty());
}

TEST(Score, is_perfect_against_itself) {
  const auto run = small_run();
  Survey survey = shifted_survey();
  survey.deposit = run.maps.deposit_thickness;
  survey.footprint = run.maps.peak_thickness;
  const auto json = json_of(run, survey);
  EXPECT_EQ(json.at("deposit_csi"), 1);
  EXPECT_EQ(json.at("footprint_csi"), 1);
  EXPECT_EQ(json.at("thickness_rmse_m"), 0);
  EXPECT_EQ(json.at("runout_difference_m"), 0);
  EXPECT_EQ(json.at("centre_of_mass_offset_m"), 0);
}

TEST(Score, leaves_out_what_a_bare_outline_cannot_tell) {
  auto survey = shifted_survey();
  survey.deposit.clear();
  const auto json = json_of(small_run(), survey);
  EXPECT_TRUE(json.contains("footprint_csi"));
  EXPECT_FALSE(json.contains("thickness_rmse_m"));
  EXPECT_EQ(json.at("not_scored").at("thickness_rmse_m"), "the survey gives a footprint only");
}

TEST(Score, has_no_runout_without_a_deposit) {
  auto run = small_run();
  run.maps.deposit_thickness.assign(run.maps.grid.count(), 0.0);
  const auto json = json_of(run, shifted_survey());
  EXPECT_FALSE(json.contains("runout_m"));
  EXPECT_EQ(json.at("deposit_csi"), 0);
  EXPECT_EQ(json.at("not_scored").at("runout_difference_m"), "the simulation has no run-out");
}

TEST(Score, table_says_the_same_in_aligned_columns) {
  const auto score = make_score(small_run(), {}, shifted_survey());
  const auto table = to_table(score);
  EXPECT_NE(table.find("Small slope\n===========\n"), std::string::npos) << table;
  EXPECT_NE(table.find("24 000 m3\n"), std::string::npos) << table;
  EXPECT_NE(table.find("0.667\n"), std::string::npos) << "deposit CSI\n" << table;
  EXPECT_NE(table.find("union of both deposits"), std::string::npos) << table;
  const auto ends_at = [&](const std::string& label, const std::string& value) {
    const auto line = table.find(label);
    return table.find(value, line) + value.size() - table.rfind('\n', line);
  };
  EXPECT_EQ(ends_at("  deposit CSI", "0.667"), ends_at("  released", "24 000")) << "numbers end in one column\n"
                                                                                << table;
}

}  // namespace
}  // namespace talus::postprocess
