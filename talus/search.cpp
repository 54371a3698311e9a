// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/ensemble/openturns.hpp"

namespace talus::command {
namespace {

constexpr double first_factor = 1.25;       // between the values that look for a bracket
constexpr double runout_tolerance = 0.01;   // of the survey's run-out: a smaller difference is none
constexpr double runout_resolution = 1.01;  // values nearer than this factor are not told apart by their run-out
constexpr double overlap_resolution = 1.03;
constexpr double same_overlap = 0.005;
const double golden = (3 - std::sqrt(5.0)) / 2;

/// What people write in a recipe.
double four_digits(double value) {
  if (value == 0) return 0;
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  return digit < 1 ? std::round(value / digit) / std::round(1 / digit) : std::round(value / digit) * digit;
}

/// A key on the scale of the search.
class Scale {
 public:
  explicit Scale(const FitKey& key) : logarithmic_(key.low > 0), low_(to(key.low)), high_(to(key.high)) {}
  double to(double value) const { return logarithmic_ ? std::log(value) : value; }
  double from(double place) const { return logarithmic_ ? std::exp(place) : place; }
  /// The step that a factor is; of a scale that is not logarithmic the same share of its width.
  double step(double factor) const { return logarithmic_ ? std::log(factor) : (factor - 1) * (high_ - low_); }
  double low() const { return low_; }
  double high() const { return high_; }
  double inside(double place) const { return std::clamp(place, low_, high_); }

 private:
  bool logarithmic_;
  double low_, high_;
};

class Search {
 public:
  Search(const FitProblem& problem, const MakeFitRun& make) : problem_(problem), make_(make) {
    for (const FitKey& key : problem.keys) {
      scales_.emplace_back(key);
      start_.push_back(scales_.back().inside(scales_.back().to(key.start)));
    }
  }

  std::vector<FitRun> run() {
    fit_runout();
    if (scales_.size() == 1)
      fit_overlap();
    else
      fit_two();
    return std::move(runs_);
  }

 private:
  bool may_run(int of) const { return static_cast<int>(runs_.size()) < of; }

  const FitScore& at(std::vector<double> places) {
    const auto known = std::ranges::find(places_, places);
    if (known != places_.end()) return runs_[static_cast<std::size_t>(known - places_.begin())].score;
    FitRun run;
    for (std::size_t n = 0; n < places.size(); ++n) {
      const FitKey& key = problem_.keys[n];
      run.values.push_back(std::clamp(four_digits(scales_[n].from(places[n])), key.low, key.high));
    }
    run.score = make_(run.values);
    places_.push_back(std::move(places));
    runs_.push_back(std::move(run));
    return runs_.back().score;
  }

  /// The difference of the run-outs with the first key at a place and the others as the recipe has them, over the
  /// survey's [-]; 0 where it is as good as none.
  double difference_at(double place) {
    std::vector<double> places = start_;
    places[0] = place;
    const double share = at(std::move(places)).runout_share();
    return std::abs(share) <= runout_tolerance ? 0 : share;
  }

  void fit_runout() {
    const int most = (problem_.runs + 1) / 2;
    double a = start_[0], f_a = difference_at(a);
    if (!std::isfinite(f_a) || f_a == 0) return;
    const Scale& scale = scales_[0];
    double step = scale.step(first_factor);
    if (scale.inside(a + step) == a) step = -step;
    double b = scale.inside(a + step), f_b = difference_at(b);
    if (std::isfinite(f_b) && f_a * f_b > 0 && std::abs(f_b) >= std::abs(f_a)) {  // the other way
      std::swap(a, b);
      std::swap(f_a, f_b);
      step = -step;
    }
    while (std::isfinite(f_b) && f_a * f_b > 0 && may_run(most)) {
      const double next = scale.inside(b + step);
      if (next == b || std::abs(f_b) > std::abs(f_a)) return;  // at a bound, or on the way back
      a = b;
      f_a = f_b;
      f_b = difference_at(b = next);
      step *= 2;
    }
    while (std::isfinite(f_b) && f_a * f_b < 0 && may_run(most) && std::abs(b - a) > scale.step(runout_resolution)) {
      const double middle = (a + b) / 2, f = difference_at(middle);
      if (!std::isfinite(f) || f == 0) return;
      (f * f_a > 0 ? a : b) = middle;
      (f * f_a > 0 ? f_a : f_b) = f;
    }
  }

  void fit_overlap() {
    const Scale& scale = scales_[0];
    while (may_run(problem_.runs)) {
      const double best = places_[best_of(runs_)][0];
      std::optional<double> left, right;
      for (const auto& place : places_) {
        if (place[0] < best) left = std::max(left.value_or(place[0]), place[0]);
        if (place[0] > best) right = std::min(right.value_or(place[0]), place[0]);
      }
      const double step = scale.step(first_factor);
      if (!left) left = scale.inside(best - step / golden);
      if (!right) right = scale.inside(best + step / golden);
      const double below = best - *left, above = *right - best;
      if (std::max(below, above) <= scale.step(overlap_resolution)) return;
      at({above > below ? best + golden * above : best - golden * below});
    }
  }

  void fit_two() {
    const auto nearest = std::ranges::min_element(runs_, {}, [](const FitRun& run) {
      return std::isfinite(run.score.runout_difference) ? std::abs(run.score.runout_difference) : 1e300;
    });
    std::vector<double> low, high, from = places_[static_cast<std::size_t>(nearest - runs_.begin())];
    for (const Scale& scale : scales_) {
      low.push_back(scale.low());
      high.push_back(scale.high());
    }
    const auto overlap = [this](const std::vector<double>& places) {
      if (!may_run(problem_.runs) && std::ranges::find(places_, places) == places_.end()) return 0.0;
      const double value = at(places).overlap;
      return std::isfinite(value) ? value : 0.0;
    };
    openturns::library().maximise(overlap, {from, low, high, scales_[0].step(first_factor), problem_.runs});
  }

  const FitProblem& problem_;
  const MakeFitRun& make_;
  std::vector<Scale> scales_;
  std::vector<double> start_;                ///< of each key, on its scale
  std::vector<std::vector<double>> places_;  ///< of the runs, likewise
  std::vector<FitRun> runs_;
};

}  // namespace

std::vector<FitRun> search(const FitProblem& problem, const MakeFitRun& make) { return Search(problem, make).run(); }

std::size_t best_of(const std::vector<FitRun>& runs) {
  if (runs.empty()) throw std::logic_error("best_of: no run");
  const auto or_else = [](double value, double none) { return std::isfinite(value) ? value : none; };
  const bool any = std::ranges::any_of(runs, [](const FitRun& run) { return std::isfinite(run.score.overlap); });
  const auto overlap_of = [&](const FitRun& run) {  // lower by one where the run-out does not fit
    const bool off = std::abs(or_else(run.score.runout_share(), 0)) > most_runout_share;
    return or_else(run.score.overlap, -1) - (off ? 1 : 0);
  };
  const double most = overlap_of(*std::ranges::max_element(runs, {}, overlap_of));
  const auto cost = [&](const FitRun& run) {
    if (!any) return std::abs(or_else(run.score.runout_difference, 1e300));
    const double own = overlap_of(run);
    return own < most - same_overlap ? 1e300 : or_else(run.score.thickness_error, most - own);
  };
  return static_cast<std::size_t>(std::ranges::min_element(runs, {}, cost) - runs.begin());
}

Steepest steepest_of(const std::vector<FitRun>& runs) {
  constexpr double least_step = 1.02;  // nearer values tell the noise of two runs
  std::vector<std::pair<double, double>> curve;
  for (const FitRun& run : runs)
    if (run.values.front() > 0 && run.score.runout > 0) curve.emplace_back(run.values.front(), run.score.runout);
  std::ranges::sort(curve);
  Steepest steepest;
  for (std::size_t n = 0; n < curve.size(); ++n) {
    std::size_t next = n + 1;
    while (next < curve.size() && curve[next].first < least_step * curve[n].first) ++next;
    if (next >= curve.size()) break;
    const double elasticity =
        std::log(curve[next].second / curve[n].second) / std::log(curve[next].first / curve[n].first);
    if (std::abs(elasticity) > std::abs(steepest.elasticity))
      steepest = {curve[n].first, curve[next].first, curve[n].second, curve[next].second, elasticity};
  }
  return steepest;
}

}  // namespace talus::command
