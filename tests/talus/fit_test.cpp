// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus fit on a scene whose survey is a run of known friction.
#include <nlohmann/json.hpp>

#include "tests/talus/bowl.hpp"

namespace talus::command {
namespace {

namespace fs = std::filesystem;

struct FitInProcess : test::SurveyedBowl {
  FitInProcess() { scratch.write("recipe.toml", recipe(28) + survey + "[fit]\nruns = 14\n"); }
  int fit(test::Listener& listener, const std::vector<std::string>& set = {}) const {
    const BindContext bind(listener.own);
    const test::NoStdout quiet;
    Request request = this->request("out");
    request.set = set;
    return fit_scene(request);
  }
  nlohmann::json kept() const { return nlohmann::json::parse(test::text_of(scratch / "out/fit.json")); }
  double fitted() const {
    const std::string text = test::text_of(scratch / "fitted.toml"), key = "\nfriction_angle_deg = ";
    return std::stod(text.substr(text.find(key) + key.size()));
  }
};

TEST_F(FitInProcess, finds_the_friction_of_the_survey_and_runs_it) {
  test::Listener listener;
  ASSERT_EQ(fit(listener), 0) << listener.text;
  EXPECT_NEAR(fitted() / truth, 1, 0.03) << listener.text;
  const std::string text = test::text_of(scratch / "fitted.toml");
  for (const char* words : {"# Fitted by talus fit", "  # of the bed", "friction_is = \"fitted\"", "[fit]"})
    EXPECT_TRUE(test::holds(text, {words})) << words << "\n" << text;
  EXPECT_TRUE(fs::exists(scratch / "out/map.png"));
  const auto runs = kept()["runs"];
  EXPECT_LE(runs.size(), 14u);
  const auto score = nlohmann::json::parse(test::text_of(scratch / "out/score.json"));
  EXPECT_EQ(score["deposit_csi"], runs[kept()["best"].get<std::size_t>()]["overlap"]);
  EXPECT_TRUE(test::holds(score["belief"][0].get<std::string>(), {"fitted to this event"}));
}

TEST_F(FitInProcess, goes_on_where_it_was_interrupted_and_repeats_nothing) {
  test::Listener first, second, third;
  int lines = 0;
  first.heard = [&](const std::string& line) {
    if (line.find('.') != std::string::npos && ++lines == 5) first.own.interrupt();
  };
  try {
    EXPECT_EQ(fit(first), 130) << first.text;
  } catch (const Interrupted&) {
  }
  const std::size_t before = kept()["runs"].size();
  EXPECT_GE(before, 1u);
  EXPECT_FALSE(fs::exists(scratch / "fitted.toml"));
  ASSERT_EQ(fit(second), 0) << second.text;
  const auto made = kept();
  ASSERT_EQ(fit(third), 0) << third.text;
  EXPECT_EQ(kept(), made);
  EXPECT_FALSE(test::holds(third.text, {"solve: [solve] has changed"})) << third.text;
  ASSERT_EQ(fit(third, {"fit.runs=5", "solve.base.friction_angle_deg=20"}), 0) << third.text;
  EXPECT_GE(kept()["others"].size() + kept()["runs"].size(), made["runs"].size());
}

TEST_F(FitInProcess, refuses_what_it_cannot_fit) {
  test::Listener listener;
  const auto refused = [&](const std::vector<std::string>& set) {
    return test::fault_of<RecipeError>([&] { fit(listener, set); });
  };
  EXPECT_TRUE(test::holds(refused({"fit.keys=[\"solve.base.friction\"]"}), {"the recipe uses no key of this name"}));
  EXPECT_TRUE(test::holds(refused({"fit.keys=[\"solve.base.law\"]"}), {"no number"}));
  EXPECT_TRUE(test::holds(refused({"fit.keys=[\"solve.start_time_s\"]"}), {"[fit] keys"}));
  EXPECT_TRUE(test::holds(refused({"ensemble.design=budget"}), {"it changes a single run"}));
  EXPECT_TRUE(test::holds(refused({"fit.low=[3.0]"}), {"[fit] low and keys differ in length"}));
  EXPECT_TRUE(
      test::holds(refused({"fit.keys=[\"postprocess.reach_cone.angle_deg\"]", "postprocess.reach_cone.angle_deg=20"}),
                  {"has no effect"}))
      << listener.text;
  scratch.write("fitted.toml", "# mine\n");
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { fit(listener); }), {"talus fit did not write it"}));
}

}  // namespace
}  // namespace talus::command
