// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus calibrate on a scene whose survey is a run of known friction.
#include <fmt/format.h>

#include <numbers>

#include <nlohmann/json.hpp>

#include "common/ensemble/member_table.hpp"
#include "tests/talus/bowl.hpp"

namespace talus::command {
namespace {

namespace fs = std::filesystem;

struct CalibrateInProcess : test::SurveyedBowl {
  CalibrateInProcess() { write({}); }
  /// The recipe with friction and thickness between these bounds.
  void write(const std::string& more, double low = 12, double high = 28) const {
    scratch.write("recipe.toml",
                  recipe(24) + survey +
                      fmt::format("[ensemble]\nmembers = 24\n"
                                  "[[ensemble.vary]]\nkey = \"solve.base.friction_angle_deg\"\nlow = {}\nhigh = {}\n",
                                  low, high) +
                      more);
  }
  int calibrate(test::Listener& listener, const std::string& out = "out",
                const std::vector<std::string>& set = {}) const {
    const BindContext bind(listener.own);
    const test::NoStdout quiet;
    Request request = this->request(out);
    request.set = set;
    return calibrate_scene(request);
  }
  nlohmann::json calibration(const std::string& out = "out") const {
    return nlohmann::json::parse(test::text_of(scratch / out / "calibration.json"));
  }
  nlohmann::json summary(const std::string& out = "out") const { return calibration(out)["summary"]; }
};

/// The angle between `low` and `high` of the run with the largest prior times likelihood.
double angle_of_best(const nlohmann::json& batches, double low, double high) {
  double best = -1e300, share = 0;
  for (const auto& batch : batches)
    for (std::size_t k = 0; k < batch["draws"].size(); ++k) {
      const double place = batch["draws"][k][0], found = batch["log_likelihood"][k].get<double>() - place * place / 2;
      if (found <= best) continue;
      best = found;
      share = std::erfc(-place / std::numbers::sqrt2) / 2;
    }
  return low + (high - low) * share;
}

constexpr const char* idle_key =
    "[[ensemble.vary]]\nkey = \"solve.material.youngs_modulus_Pa\"\nlow = 1.0e6\nhigh = 1.000001e6\n";

TEST_F(CalibrateInProcess, finds_the_friction_of_the_survey_and_gives_it_to_the_next_slide) {
  test::Listener listener;
  ASSERT_EQ(calibrate(listener), 0) << listener.text;
  const auto key = summary()["keys"][0];
  EXPECT_EQ(key["key"], "solve.base.friction_angle_deg");
  EXPECT_NEAR(key["after"][1].get<double>(), truth, 0.5) << listener.text;
  EXPECT_LT(key["after"][2].get<double>() - key["after"][0].get<double>(), 3);
  EXPECT_LT(key["left"], 0.2);
  for (const char* file : {"out/posterior.csv", "out/ensemble.html", "out/probability.nc"})
    EXPECT_TRUE(fs::exists(scratch / file)) << file;
  const std::string fitted = test::text_of(scratch / "fitted.toml");
  EXPECT_TRUE(test::holds(fitted, {"# Fitted by talus calibrate", "members = 0", "friction_is = \"fitted\""}))
      << fitted;
  EXPECT_NEAR(std::stod(fitted.substr(fitted.find("\nfriction_angle_deg = ") + 22)),
              angle_of_best(calibration()["batches"], 12, 28), 1e-9);
  EXPECT_TRUE(test::holds(listener.text, {"no discrepancy is found"})) << "the survey is a run of the same model";
  scratch.write("recipe.toml", recipe(24) + "[ensemble]\nmembers = 8\nprior = \"out/posterior.csv\"\n");
  const BindContext bind(listener.own);
  const test::NoStdout quiet;
  ASSERT_EQ(run_scene(request("next")), 0) << listener.text;
  const MemberTable members = read_member_table(EnsemblePaths{scratch / "next"}.members());
  ASSERT_EQ(members.columns.size(), 1u);
  for (const double angle : members.columns[0].values)
    EXPECT_NEAR(angle, key["after"][1].get<double>(), key["after"][2].get<double>() - key["after"][0].get<double>());
  EXPECT_TRUE(test::holds(test::text_of(scratch / "next/ensemble.html"), {"24 draws of", "posterior.csv"}));
}

TEST_F(CalibrateInProcess, goes_on_where_it_was_killed_with_the_same_bits) {
  test::Listener whole, killed, second;
  const std::vector<std::string> few{"ensemble.members=12"};
  ASSERT_EQ(calibrate(whole, "whole", few), 0) << whole.text;
  int batches = 0;
  killed.heard = [&](const std::string& line) {
    if (test::holds(line, {"largest log-likelihood"}) && ++batches == 3) killed.own.interrupt();
  };
  try {
    EXPECT_EQ(calibrate(killed, "killed", few), 130) << killed.text;
  } catch (const Interrupted&) {
  }
  EXPECT_FALSE(fs::exists(scratch / "killed/posterior.csv"));
  ASSERT_EQ(calibrate(second, "killed", few), 0) << second.text;
  EXPECT_TRUE(test::holds(second.text, {"36 runs (known)"})) << second.text;
  EXPECT_FALSE(test::holds(second.text, {"48 runs (known)"})) << second.text;
  EXPECT_EQ(test::text_of(scratch / "killed/posterior.csv"), test::text_of(scratch / "whole/posterior.csv"));
}

TEST_F(CalibrateInProcess, says_which_key_the_survey_does_not_tell) {
  write(idle_key);
  test::Listener listener;
  ASSERT_EQ(calibrate(listener), 0) << listener.text;
  EXPECT_TRUE(test::holds(listener.text, {"The survey does not determine youngs_modulus_Pa"})) << listener.text;
  EXPECT_FALSE(test::holds(listener.text, {"does not determine friction_angle_deg"})) << listener.text;
}

TEST_F(CalibrateInProcess, says_that_the_truth_may_lie_beyond_the_prior) {
  write({}, 12, 17);
  test::Listener listener;
  ASSERT_EQ(calibrate(listener), 0) << listener.text;
  EXPECT_TRUE(test::holds(listener.text, {"friction_angle_deg lies in the upper 5 %"})) << listener.text;
}

TEST_F(CalibrateInProcess, corrects_larger_cells_by_the_recipes_own) {
  write({}, 18, 20);
  test::Listener listener;
  ASSERT_EQ(calibrate(listener, "out", {"calibrate.cell_factor=2", "ensemble.members=12"}), 0) << listener.text;
  EXPECT_NEAR(summary()["keys"][0]["after"][1].get<double>(), truth, 0.5) << listener.text;
  EXPECT_TRUE(test::holds(listener.text, {"own cells, exponent 1"})) << listener.text;
}

TEST_F(CalibrateInProcess, refuses_what_it_cannot_calibrate) {
  test::Listener listener;
  const auto refused = [&](const std::vector<std::string>& set) {
    return test::fault_of<RecipeError>([&] { calibrate(listener, "out", set); });
  };
  EXPECT_TRUE(test::holds(refused({"ensemble.members=6"}), {"1 keys need 10 draws"}));
  EXPECT_TRUE(test::holds(refused({"ensemble.design=budget"}), {"it draws nothing"}));
  EXPECT_TRUE(
      test::holds(refused({"ensemble.elevation_error.terrain_deviation_m=1", "ensemble.elevation_error.range_m=50"}),
                  {"the survey's error is in the likelihood"}));
  scratch.write("recipe.toml", recipe(24) +
                                   "[ensemble]\nmembers = 24\n[[ensemble.vary]]\n"
                                   "key = \"solve.base.friction_angle_deg\"\nlow = 12\nhigh = 28\n");
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { calibrate(listener); }), {"compared with nothing"}));
}

}  // namespace
}  // namespace talus::command
