// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the report takes from the history and the provenance, and how it calls what the run is compared with.
#include <fmt/format.h>

#include "tests/postprocess/report/report_of_run.hpp"

namespace talus::postprocess {
namespace {

class ReportWords : public ReportOfRun {};

TEST_F(ReportWords, volume_in_motion_comes_from_every_record_of_the_history) {
  run_.history.columns = {
      {.name = "time_s", .unit = "s", .quantity = "", .place = "", .values = {0, 0.5, 1}},
      {.name = "moving_volume_m3", .unit = "m3", .quantity = "", .place = "", .values = {0, 700, 900}},
      {.name = "moving_speed_m_s", .unit = "m s-1", .quantity = "", .place = "", .values = {0, 2, 3.25}}};
  Json motion = data_of(report_html(input()))["series"]["motion"];
  EXPECT_TRUE(motion["from_history"]);
  EXPECT_EQ(motion["time"], (Json{0, 0.5, 1}));
  EXPECT_EQ(motion["volume"], (Json{0, 700, 900}));
  EXPECT_EQ(motion["mean_speed"], (Json{0, 2, 3.25}));
  run_.history.columns.resize(2);  // a run from before
  motion = data_of(report_html(input()))["series"]["motion"];
  EXPECT_TRUE(motion.is_null() || !motion["from_history"].get<bool>());
}

TEST_F(ReportWords, gauges_and_obstacles_stand_on_the_map_with_what_was_measured) {
  EXPECT_TRUE(data_of(report_html(input()))["places"].empty());
  const auto window = shown_window(input());
  run_.summary.places = {{"gauge toe", {{{window.west + 30, window.south + 40}}}},
                         {"obstacle wall", {{{0, 0}, {4, 0}, {4, 9}}}}};
  run_.history.columns = {
      {.name = "time_s", .unit = "s", .quantity = "", .place = "", .values = {0, 20, 40}},
      {.name = "gauge_toe_thickness_m",
       .unit = "m",
       .quantity = "thickness",
       .place = "gauge toe",
       .values = {0, 3, 1}},
      {.name = "x", .unit = "N s", .quantity = "impulse", .place = "obstacle wall", .values = {0, nan, -5}}};
  const Json places = data_of(report_html(input()))["places"];
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0]["kind"], "gauge");
  EXPECT_EQ(places[0]["name"], "toe");
  EXPECT_EQ(places[0]["rings"], (Json{{30.0, 40.0}}));
  EXPECT_EQ(places[0]["measured"][0], (Json{{"quantity", "thickness"}, {"unit", "m"}, {"value", 3.0}, {"time", 20.0}}));
  EXPECT_EQ(places[1]["rings"][0].size(), 6U);
  EXPECT_EQ(places[1]["measured"][0]["value"], -5.0) << "the farthest from zero";
}

TEST_F(ReportWords, another_models_run_is_not_called_surveyed) {
  survey_it();
  survey_->name = "SHALTOP";
  const auto words_of = [](const Score& score) {
    std::string words;
    for (const auto& section : score.sections) {
      words += section.title + "\n";
      for (const auto& entry : section.entries) words += entry.label + "\n";
    }
    for (const auto& [key, why] : score.not_scored) words += why + "\n";
    for (const auto& note : score.notes) words += note + "\n";
    return words;
  };
  EXPECT_TRUE(test::holds(words_of(make_score(run_, options_, survey_, thalweg_)), {"surveyed deposit volume"}));
  survey_->kind = ReferenceKind::model;
  std::string words = words_of(make_score(run_, options_, survey_, thalweg_));
  EXPECT_TRUE(test::holds(words, {"reference deposit volume"}));
  const std::string denial = "It was not surveyed.";
  ASSERT_TRUE(test::holds(words, {denial}));
  words.erase(words.find(denial), denial.size());
  EXPECT_FALSE(test::holds(words, {"survey"})) << words.substr(words.find("survey") - 60, 120);
  EXPECT_EQ(data_of(report_html(input()))["run"]["survey"]["noun"], "reference");
}

}  // namespace
}  // namespace talus::postprocess
