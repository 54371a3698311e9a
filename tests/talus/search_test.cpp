// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The search of talus fit on scores of closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "talus/search.hpp"

namespace talus::command {
namespace {

/// Scores of a slide whose run-out falls with its friction, around one that is known.
struct Slope {
  double truth = 17, surveyed = 800, power = 1.2;
  double shift = 1;  ///< of the value with the largest overlap over the true one
  FitScore operator()(double friction) const {
    FitScore score;
    score.runout = surveyed * std::pow(truth / friction, power);
    score.runout_difference = score.runout - surveyed;
    score.overlap = std::exp(-std::abs(std::log(friction / (shift * truth))) / 0.3);
    score.thickness_error = 1 + std::abs(friction - shift * truth);
    return score;
  }
};

std::vector<FitRun> search_one(const auto& score, double start, int runs = 16, double low = 4, double high = 60) {
  return search({{{"a", start, low, high}}, runs}, [&](const std::vector<double>& values) { return score(values[0]); });
}

TEST(FitSearch, finds_a_friction_from_far_off_either_way) {
  for (const double truth : {5.0, 9.0, 17.0, 31.0, 50.0})
    for (const double start : {6.0, 15.0, 17.0, 44.0}) {
      const auto runs = search_one(Slope{.truth = truth}, start);
      EXPECT_LE(runs.size(), 16u);
      EXPECT_NEAR(runs[best_of(runs)].values[0] / truth, 1, 0.02) << start << " for " << truth;
    }
}

TEST(FitSearch, takes_a_key_with_which_the_run_out_grows) {
  const Slope slope{.truth = 1000, .power = -0.7};
  const auto runs = search_one(slope, 300, 16, 75, 1200);
  EXPECT_NEAR(runs[best_of(runs)].values[0] / 1000, 1, 0.02);
}

TEST(FitSearch, goes_by_the_overlap_as_far_as_the_run_out_fits) {
  const auto near = search_one(Slope{.shift = 1.06}, 25), far = search_one(Slope{.shift = 1.5}, 25);
  EXPECT_NEAR(near[best_of(near)].values[0] / (1.06 * 17), 1, 0.02);
  EXPECT_LE(std::abs(far[best_of(far)].score.runout_share()), most_runout_share);
  EXPECT_GT(far[best_of(far)].values[0], 17);
}

TEST(FitSearch, stays_between_the_bounds_and_within_its_runs) {
  for (const double truth : {2.0, 100.0}) {
    const auto runs = search_one(Slope{.truth = truth}, 20, 9, 10, 40);
    EXPECT_LE(runs.size(), 9u);
    for (const FitRun& run : runs) {
      EXPECT_GE(run.values[0], 10 * (1 - 1e-12));
      EXPECT_LE(run.values[0], 40 * (1 + 1e-12));
    }
    EXPECT_NEAR(runs[best_of(runs)].values[0], truth < 10 ? 10 : 40, 0.5);
  }
}

TEST(FitSearch, makes_no_run_twice) {
  const auto runs = search_one(Slope{}, 22);
  std::vector<double> values;
  for (const FitRun& run : runs) values.push_back(run.values[0]);
  std::ranges::sort(values);
  EXPECT_EQ(std::ranges::adjacent_find(values), values.end());
}

TEST(FitSearch, finds_the_edge_of_a_cliff_and_says_how_steep_it_is) {
  const auto cliff = [](double friction) {  // the slide stops behind a rim, or goes far beyond it
    FitScore score;
    score.runout = friction < 16.4 ? 760 - friction : 420 - friction;
    score.runout_difference = score.runout - 600;
    score.overlap = friction < 16.4 ? 0.5 - std::abs(friction - 16) / 50 : 0.3;
    return score;
  };
  const auto runs = search_one(cliff, 22);
  EXPECT_NEAR(runs[best_of(runs)].values[0], 16.2, 0.3);
  const Steepest steepest = steepest_of(runs);
  EXPECT_LE(steepest.low, 16.4);
  EXPECT_GE(steepest.high, 16.4);
  EXPECT_LT(steepest.elasticity, -3);
  EXPECT_GT(steepest.runout_low, 700);
  EXPECT_LT(steepest.runout_high, 450);
}

TEST(FitSearch, does_not_run_away_where_no_run_out_fits) {
  const auto thin_rim = [](double friction) {  // too far at any friction, least at 20
    FitScore score;
    score.runout = 2500 + 4000 * std::pow(std::log(friction / 20), 2);
    score.runout_difference = score.runout - 2200;
    score.overlap = 0.7 - std::abs(std::log(friction / 20));
    return score;
  };
  const auto runs = search_one(thin_rim, 15);
  EXPECT_NEAR(runs[best_of(runs)].values[0], 20, 0.5);
  for (const FitRun& run : runs) EXPECT_LT(run.values[0], 40);
}

TEST(FitSearch, does_without_a_run_out_or_without_an_overlap) {
  const auto without = [](auto number) {
    return [number](double friction) {
      FitScore score = Slope{}(friction);
      score.*number = std::nan("");
      return score;
    };
  };
  const auto by_overlap = search_one(without(&FitScore::runout_difference), 22);
  EXPECT_NEAR(by_overlap[best_of(by_overlap)].values[0], 17, 0.5);
  const auto by_runout = search_one(without(&FitScore::overlap), 22);
  EXPECT_NEAR(by_runout[best_of(by_runout)].values[0], 17, 0.3);
}

TEST(FitSearch, fits_two_keys_of_which_many_pairs_give_the_run_out) {
  const auto score = [](const std::vector<double>& values) {
    const double mu = values[0] / 0.2, xi = values[1] / 1000;
    FitScore found;
    found.runout = 900 / std::pow(mu, 1.0) * std::pow(xi, 0.3);
    found.runout_difference = found.runout - 900;
    const double along = std::log(mu), across = std::log(xi);
    found.overlap = 1 / (1 + 9 * std::pow(along - 0.3 * across, 2) + 2 * along * along + across * across / 2);
    return found;
  };
  const auto runs = search({{{"mu", 0.3, 0.075, 1.2}, {"xi", 2000, 500, 8000}}, 20}, score);
  EXPECT_LE(runs.size(), 20u);
  const FitRun& best = runs[best_of(runs)];
  EXPECT_NEAR(best.values[0] / 0.2, 1, 0.12);
  EXPECT_NEAR(best.values[1] / 1000, 1, 0.3);
  EXPECT_GT(best.score.overlap, 0.95);
}

TEST(FitSearch, passes_on_what_a_run_throws) {
  int calls = 0;
  const auto fails = [&](const std::vector<double>& values) {
    if (++calls == 11) throw std::runtime_error("no more");
    return Slope{}(values[0] * values[1]);
  };
  EXPECT_THROW(search({{{"a", 2, 0.5, 8}, {"b", 3, 1, 12}}, 20}, fails), std::runtime_error);
  EXPECT_EQ(calls, 11);
}

TEST(FitSearch, tells_equal_overlaps_apart_by_the_thickness) {
  const std::vector<FitRun> runs{{{1}, {500, 0, 0.601, 2}}, {{2}, {500, 0, 0.604, 3}}, {{3}, {500, 0, 0.2, 0.1}}};
  EXPECT_EQ(best_of(runs), 0u);
}

}  // namespace
}  // namespace talus::command
