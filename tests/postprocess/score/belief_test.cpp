// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/belief.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/stage/identity.hpp"
#include "postprocess/score/thalweg.hpp"
#include "tests/common/findings.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::holds;

Score score_of(const talus::Run& run, const Options& options = {}, const std::optional<Survey>& survey = {}) {
  return make_score(run, options, survey, thalweg_of(run, options, survey));
}

TEST(Belief, says_where_the_friction_comes_from) {
  const auto run = test::small_run();
  Options options;
  const auto first = [&] { return score_of(run, options).belief.at(0); };
  EXPECT_TRUE(holds(first(), {"The friction (no friction) may be measured, guessed or fitted", "friction_is"}));
  options.leaves_friction = true;
  EXPECT_TRUE(holds(first(), {"program's default"}));
  options.friction_is = FrictionIs::guessed;
  EXPECT_TRUE(holds(first(), {"a guess, neither measured nor fitted"}));
  options.friction_is = FrictionIs::fitted;
  EXPECT_TRUE(holds(first(), {"fitted to this event"}));
  options.friction_is = FrictionIs::given;
  EXPECT_TRUE(holds(first(), {"given from elsewhere"}));
}

TEST(Belief, says_where_the_volume_comes_from) {
  auto run = test::small_run();
  EXPECT_TRUE(holds(score_of(run).belief.at(0), {"the volume of 24 000 m3 is of a source that nothing names."}));
  run.summary.provenance = {{volume_source, "guessed from the area of its outline, an order of magnitude"}};
  EXPECT_TRUE(holds(score_of(run).belief.at(0), {"is guessed from the area of its outline, an order of magnitude."}));
}

TEST(Belief, says_how_far_the_run_ends_from_the_survey) {
  const auto run = test::small_run();
  EXPECT_TRUE(holds(score_of(run).belief.at(1), {"No survey says how far"}));
  Survey survey;
  survey.name = "lidar";
  survey.grid = test::small_grid();
  survey.deposit = block(survey.grid, 27, 37, 10, 20, 2.0);
  const auto second = [&] { return score_of(run, {}, survey).belief.at(1); };
  EXPECT_TRUE(holds(second(), {"(thicker than 0.1 m) ends 19 m short of the end of \"lidar\""}));
  survey.deposit = block(survey.grid, 25, 34, 10, 20, 2.0);
  EXPECT_TRUE(holds(second(), {"ends 10 m beyond the end of \"lidar\""}));
  survey.kind = ReferenceKind::model;
  EXPECT_TRUE(holds(second(), {"which is another model's run"}));
}

TEST(Belief, names_the_warnings_of_all_stages_in_json_and_table) {
  auto run = test::small_run();
  EXPECT_TRUE(holds(score_of(run).belief.at(1), {"no stage warns of anything"}));
  run.summary.findings = {{Severity::warning, "assumed-volume", "NOTHING SAYS HOW DEEP", {}, "preprocess"},
                          {Severity::warning, "spikes", "one", {}, "preprocess"},
                          {Severity::warning, "spikes", "two", {}, "preprocess"},
                          {Severity::advice, "friction", "advice is no warning", {}, "solve"},
                          test::finding(Severity::refusal, "swapped-surveys", "what rose lies higher")};
  const Score score = score_of(run);
  ASSERT_EQ(score.belief.size(), 3U);
  EXPECT_TRUE(holds(score.belief[1], {"4 warnings: assumed-volume of [preprocess]; spikes of [preprocess] (2 times); "
                                      "swapped-surveys of [preprocess], accepted."}));
  EXPECT_TRUE(holds(score.belief[2], {"may not be used by itself to call a place safe"}));
  EXPECT_EQ(nlohmann::json::parse(to_json(score)).at("belief").get<std::vector<std::string>>(), score.belief);
  std::string table = to_table(score);
  std::replace(table.begin(), table.end(), '\n', ' ');
  for (const std::string& sentence : score.belief) EXPECT_TRUE(holds(table, {sentence}));
}

}  // namespace
}  // namespace talus::postprocess
