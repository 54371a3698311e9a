// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/score.hpp"

#include <nlohmann/json.hpp>

#include "postprocess/score/contingency.hpp"
#include "tests/common/findings.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::holds;
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

Survey measured_survey() {
  Survey survey = shifted_survey();
  survey.measured = survey.deposit;
  survey.error = {std::vector<double>(survey.grid.count(), 0.5), 30, 1.96};
  return survey;
}

nlohmann::json json_of(const Run& run, const std::optional<Survey>& survey, const Options& options = {}) {
  return nlohmann::json::parse(to_json(make_score(run, options, survey, thalweg_of(run, options))));
}

/// These keys have these values.
void expect_values(const nlohmann::json& found, const nlohmann::json& expected) {
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(found.at(key), value) << key;
}

TEST(Score, holds_the_runs_numbers_without_a_survey) {
  const auto json = json_of(small_run(), {});
  expect_values(json, {{"volume_released_m3", 24000}, {"volume_outflow_m3", 0}, {"volume_closure_error", 0}});
  EXPECT_NEAR(json.at("volume_map_error").get<double>(), 0, 1e-12);
  expect_values(json, {{"particles", 320},
                       {"steps", 77},
                       {"wall_time_s", 0.25},
                       {"on", "cpu"},
                       {"affected_area_m2", 320 * 100},
                       {"max_deposit_thickness_m", 6.5}});
  EXPECT_FALSE(json.contains("deposit_csi"));
  EXPECT_EQ(json.at("not_scored").at("deposit_csi"), "no survey is given");
}

TEST(Score, measures_runout_from_the_crown_to_the_farthest_deposit_and_along_the_thalweg) {
  const auto run = small_run();
  const auto json = json_of(run, {});
  const double length = json.at("runout_m"), drop = json.at("drop_m");
  EXPECT_NEAR(length, std::hypot(31 * 10.0, 9 * 10.0), 60) << "31 columns, up to 9 rows";
  EXPECT_GE(length, 310);
  EXPECT_NEAR(drop, 31 * 5.0 + 6, 8) << "5 m a column, and the release's own thickness";
  EXPECT_DOUBLE_EQ(json.at("h_over_l").get<double>(), drop / length);
  EXPECT_NEAR(json.at("thalweg_runout_m").get<double>(), 310, 45) << "31 columns, and a way of up to 9 rows across";
  EXPECT_GE(json.at("thalweg_runout_m").get<double>(), json.at("runout_m").get<double>() - 1e-9)
      << "a bend is no shorter";
  EXPECT_NEAR(json.at("thalweg_fahrboeschung_deg").get<double>(),
              std::atan(json.at("thalweg_h_over_l").get<double>()) * 180 / 3.14159265358979, 1e-9);
  EXPECT_NEAR(json.at("max_drop_m").get<double>(), 31 * 5 + 6 + 4, 6) << "the last column's lowest row";
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
  // 100 cells the survey says yes to against 1100: the 80 in both outrank 1080 dry ones, the 20 missed tie with them;
  // against the 20 false ones of 1.5 m the 18 of 6.5 m win, the 62 of 1.5 m tie and the missed lose.
  EXPECT_NEAR(json.at("deposit_auroc").get<double>(),
              (80 * 1080 + 20 * 0.5 * 1080 + 18 * 20 + 62 * 0.5 * 20) / (100 * 1100.0), 1e-12);
  EXPECT_EQ(json.at("not_scored").size(), 4u);
  for (const auto* key : {"residual_median_sigma", "residual_within_95", "residual_chi2", "deposit_csi_sd"})
    EXPECT_EQ(json.at("not_scored").at(key), "the survey's error (sigma) is not given");
}

TEST(Score, compares_along_a_line) {
  const auto run = small_run();
  const Thalweg line{
      .line = {{600000, 5100150}, {600400, 5100150}}, .distance = {0, 400}, .given = true, .origin = "line"};
  const std::optional<Survey> survey = shifted_survey();
  const auto json = nlohmann::json::parse(to_json(make_score(run, {}, survey, line)));
  EXPECT_DOUBLE_EQ(json.at("thalweg_runout_m").get<double>(), 310) << "from the crown in column 3 to column 34";
  EXPECT_DOUBLE_EQ(json.at("survey_thalweg_runout_m").get<double>(), 330);
  EXPECT_DOUBLE_EQ(json.at("thalweg_runout_difference_m").get<double>(), -20);
  // 150 m of thickness about x = 300 and 90 m about x = 295, against x = 320.
  EXPECT_NEAR(json.at("centre_of_mass_offset_along_m").get<double>(), (150 * 300 + 90 * 295) / 240.0 - 320, 1e-9);
  const Contingency deposit{.true_positive = 80, .false_positive = 20, .false_negative = 20, .true_negative = 1080};
  EXPECT_NEAR(json.at("deposit_spi").get<double>(), deposit.spi(310.0 / 330), 1e-12);
  const Contingency footprint{.true_positive = 320, .false_positive = 0, .false_negative = 20, .true_negative = 860};
  EXPECT_NEAR(json.at("footprint_spi").get<double>(), footprint.spi(310.0 / 330), 1e-12);
}

TEST(Score, says_the_release_by_both_conventions) {
  auto run = small_run();
  test::tilt(run.maps);
  const auto json = json_of(run, {});
  EXPECT_NEAR(json.at("volume_if_thickness_were_slope_normal_m3").get<double>(), 24000 * 1.25, 1e-6)
      << "slope 3 : 4 : 5";
  EXPECT_EQ(json.at("release_area_m2"), 4000);
  EXPECT_NEAR(json.at("release_true_area_m2").get<double>(), 5000, 1e-6);
  EXPECT_NEAR(json.at("max_release_thickness_slope_normal_m").get<double>(), 4.8, 1e-9);
}

/// The map of the start is spread by shape functions; the release itself has sharp edges.
TEST(Score, says_of_the_release_what_preprocess_said) {
  auto run = small_run();
  run.summary.provenance = {{"released_area_projected_m2", "3600"},
                            {"released_area_true_m2", "4281.5"},
                            {"volume_if_thickness_were_slope_normal_m3", "25999"},
                            {"max_thickness_vertical_m", "15.69"},
                            {"max_thickness_slope_normal_m", "14.88"}};
  const auto json = json_of(run, {});
  expect_values(json, {{"release_area_m2", 3600},
                       {"release_true_area_m2", 4281.5},
                       {"volume_if_thickness_were_slope_normal_m3", 25999},
                       {"max_release_thickness_m", 15.69},
                       {"max_release_thickness_slope_normal_m", 14.88}});
}

TEST(Score, has_the_findings_of_all_stages) {
  auto run = small_run();
  EXPECT_TRUE(json_of(run, {}).at("findings").empty());
  run.summary.findings = {test::finding(Severity::refusal, "swapped-surveys", "what rose lies higher"),
                          {Severity::warning, "coarse-grid", "the grid is coarse", {{"layers", 2, "1"}}, "preprocess"}};
  const auto found = json_of(run, {}).at("findings");
  EXPECT_EQ(found.at(0).at("accepted_by"), "accept in [preprocess]");
  EXPECT_EQ(found.at(1).at("severity"), "warning");
  EXPECT_EQ(found.at(1).at("numbers").at("layers").at("value"), 2);
  EXPECT_TRUE(holds(to_table(make_score(run, {}, {}, thalweg_of(run, {}))),
                    {"Refused and accepted in [preprocess], \"swapped-surveys\": what rose"}));
}

TEST(Score, warns_of_a_run_that_ended_while_a_hundredth_of_it_moved) {
  auto run = small_run();
  const auto found = [&](double moving, double energy) {
    run.history.columns = {{"kinetic_J", "J", "", "", {9e9, energy}},
                           {"volume_m3", "m3", "", "", {24000, 24000}},
                           {"moving_volume_m3", "m3", "", "", {20000, moving}},
                           {"moving_speed_m_s", "m s-1", "", "", {30, 2.5}}};
    return test::findings_of([&] { warn_of_end(run); });
  };
  EXPECT_TRUE(found(239, 8e7).empty());
  EXPECT_EQ(found(0, 9e9).size(), 1u) << "a slow slide";
  const std::vector<Finding> ended = found(480, 9e6);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].name, "ended-before-rest");
  EXPECT_TRUE(holds(ended[0].message, {"0.1 %", "480 m3", "2 %", "2.5 m/s", "end time"}));
}

TEST(Score, names_what_water_carried_where_there_was_any) {
  auto run = small_run();
  EXPECT_FALSE(json_of(run, {}).contains("max_liquefied_share"));
  run.history.columns.push_back(
      {.name = "liquefied_share", .unit = "1", .quantity = "", .place = "", .values = {0, 0.4, 0.1}});
  run.maps.peak_pore_pressure = block(small_grid(), 3, 8, 10, 20, 0.9);
  const nlohmann::json json = json_of(run, {});
  EXPECT_EQ(json.at("max_liquefied_share"), 0.4);
  EXPECT_EQ(json.at("max_pore_pressure_ratio"), 0.9);
}

TEST(Score, measures_residuals_by_the_surveys_error_and_warns_where_it_hides_deposit) {
  auto survey = measured_survey();
  const auto json = json_of(small_run(), survey);
  // In units of 0.5 m: 20 cells 3 too thick, 20 cells 4 too thin, 18 cells 9 too thick, 62 cells 1 too thin.
  expect_values(json, {{"residual_cells", 120}, {"residual_median_sigma", -1}});
  EXPECT_NEAR(json.at("residual_within_95").get<double>(), 62.0 / 120, 1e-12);
  EXPECT_NEAR(json.at("residual_chi2").get<double>(), (20 * 9 + 20 * 16 + 18 * 81 + 62 * 1) / 120.0, 1e-12);
  EXPECT_GT(json.at("deposit_csi_sd").get<double>(), 0);
  EXPECT_EQ(json.at("not_scored").at("footprint_csi_sd"),
            "the footprint is not a surveyed change, its error is not known");
  Options options;
  options.deposit_threshold = 1;
  const auto notes = [&] { return json_of(small_run(), survey, options).at("notes").dump(); };
  EXPECT_FALSE(holds(notes(), {"level of detection lies above"})) << "0.98 m against 1 m";
  survey.error.sigma.assign(survey.grid.count(), 0.6);
  EXPECT_TRUE(holds(notes(), {"above the deposit threshold of 1 m on 100 %"}));
}

TEST(Score, is_perfect_against_itself) {
  const auto run = small_run();
  Survey survey = shifted_survey();
  survey.deposit = run.maps.deposit_thickness;
  survey.footprint = run.maps.peak_thickness;
  const auto json = json_of(run, survey);
  expect_values(json, {{"deposit_csi", 1},
                       {"footprint_csi", 1},
                       {"thickness_rmse_m", 0},
                       {"runout_difference_m", 0},
                       {"centre_of_mass_offset_m", 0}});
}

TEST(Score, leaves_out_what_a_bare_outline_cannot_tell_and_has_no_runout_without_a_deposit) {
  auto survey = shifted_survey();
  survey.deposit.clear();
  const auto json = json_of(small_run(), survey);
  EXPECT_TRUE(json.contains("footprint_csi"));
  EXPECT_FALSE(json.contains("thickness_rmse_m"));
  EXPECT_EQ(json.at("not_scored").at("thickness_rmse_m"), "the survey gives a footprint only");
  auto run = small_run();
  run.maps.deposit_thickness.assign(run.maps.grid.count(), 0.0);
  const auto none = json_of(run, shifted_survey());
  EXPECT_FALSE(none.contains("runout_m"));
  EXPECT_EQ(none.at("deposit_csi"), 0);
  EXPECT_EQ(none.at("not_scored").at("runout_difference_m"), "the simulation has no run-out");
}

TEST(Score, table_says_the_same_in_aligned_columns) {
  const auto score = make_score(small_run(), {}, shifted_survey(), thalweg_of(small_run(), {}));
  const auto table = to_table(score);
  EXPECT_TRUE(holds(table, {"Small slope\n===========\n", "24 000 m3\n"}));
  EXPECT_TRUE(holds(table, {"0.667\n"})) << "deposit CSI";
  EXPECT_TRUE(holds(table, {"union of both deposits"}));
  const auto ends_at = [&](const std::string& label, const std::string& value) {
    const auto line = table.find(label);
    return table.find(value, line) + value.size() - table.rfind('\n', line);
  };
  EXPECT_EQ(ends_at("  deposit CSI", "0.667"), ends_at("  released", "24 000")) << "numbers end in one column\n"
                                                                                << table;
}

}  // namespace
}  // namespace talus::postprocess
