// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/marginal.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/ensemble/csv.hpp"

namespace talus::preprocess {
namespace {

using openturns::AnyLaw;

constexpr double least_share = 1e-6;  // of a distribution that must be left between low and high

[[noreturn]] void refuse_vary(const VaryOptions& o, const std::string& what, const std::string& why,
                              const std::string& mend) {
  throw RecipeError({"[[ensemble.vary]] of " + o.key + ": " + what, why, mend});
}

/// What is left of a distribution between low and high, where they are given.
AnyLaw cut_off(const AnyLaw& whole, const VaryOptions& o) {
  if (!o.low && !o.high) return whole;
  const double below = o.low ? whole->below(*o.low) : 0.0, beyond = o.high ? 1 - whole->below(*o.high) : 0.0;
  const double left = 1 - below - beyond;
  if (!(left >= least_share))
    refuse_vary(o, fmt::format("low and high leave {:.2g} of the distribution", std::max(0.0, left)),
                fmt::format("its mean is {:g}, its deviation {:g}", *o.mean, *o.deviation),
                "Give bounds around the mean, or a larger deviation");
  return whole->between(o.low, o.high);
}

/// Beta on [low, high] by mean and deviation, which must leave its two shapes positive.
AnyLaw beta_of(const VaryOptions& o) {
  const double low = *o.low, high = *o.high, mean = *o.mean, most = (mean - low) * (high - mean);
  if (!(mean > low && mean < high))
    refuse_vary(o, fmt::format("mean = {:g} is not between low and high", mean), "the distribution lies there",
                "Mend one of them");
  if (!(*o.deviation * *o.deviation < most))
    refuse_vary(o, fmt::format("deviation = {:g} is too large", *o.deviation),
                fmt::format("with this mean no distribution between {:g} and {:g} has one of {:g} or more", low, high,
                            std::sqrt(most)),
                "Give a smaller one, or wider bounds");
  return openturns::library().beta(mean, *o.deviation, low, high);
}

/// A density that is linear between the rows of a table: a mixture of triangles, one over each row.
AnyLaw tabulated(const VaryOptions& o) {
  const std::vector<DensityRow> rows = read_density(o.table);
  std::vector<openturns::Triangle> parts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double from = rows[i == 0 ? 0 : i - 1].value, to = rows[std::min(i + 1, rows.size() - 1)].value;
    if (!(rows[i].density > 0)) continue;
    parts.push_back({from, rows[i].value, to, rows[i].density * (to - from) / 2});
  }
  return openturns::library().triangles(parts);
}

/// What a discrete key chooses from, numbers in growing order, without what has no weight.
struct Choices {
  std::vector<double> values;
  std::vector<std::string> words;
  std::vector<double> weights;
};

Choices choices_of(const VaryOptions& o) {
  if (!o.values.empty() && !o.words.empty())
    refuse_vary(o, "values and words are both given", "a key is a number or a word", "Leave one of them out");
  const std::size_t count = o.values.size() + o.words.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (o.words.empty()) std::ranges::stable_sort(order, [&](auto a, auto b) { return o.values[a] < o.values[b]; });
  Choices choices;
  for (const std::size_t i : order) {
    if (!o.weights.empty() && !(o.weights[i] > 0)) continue;
    choices.weights.push_back(o.weights.empty() ? 1.0 : o.weights[i]);
    choices.values.push_back(o.words.empty() ? o.values[i] : static_cast<double>(choices.words.size()));
    if (!o.words.empty()) choices.words.push_back(o.words[i]);
  }
  const bool twice = o.words.empty()
                         ? std::adjacent_find(choices.values.begin(), choices.values.end()) != choices.values.end()
                         : std::ranges::any_of(o.words, [&](const std::string& word) {
                             return std::count(o.words.begin(), o.words.end(), word) > 1;
                           });
  if (twice) refuse_vary(o, "a value is there twice", "each has one weight", "Leave one out, and give it the weight");
  return choices;
}

AnyLaw continuous(const VaryOptions& o) {
  const openturns::Library& laws = openturns::library();
  switch (o.distribution) {
    case Distribution::normal: return cut_off(laws.normal(*o.mean, *o.deviation), o);
    case Distribution::lognormal: return cut_off(laws.lognormal(*o.mean, *o.deviation), o);
    case Distribution::triangular: return laws.triangular(*o.low, *o.mode, *o.high);
    case Distribution::beta: return beta_of(o);
    case Distribution::table: return tabulated(o);
    case Distribution::uniform:
    case Distribution::draws:
    case Distribution::discrete: break;
  }
  return laws.uniform(*o.low, *o.high);
}

std::size_t place_of_key(const std::vector<VaryOptions>& vary, const std::string& key) {
  const auto found = std::ranges::find_if(vary, [&](const VaryOptions& one) { return one.key == key; });
  return static_cast<std::size_t>(found - vary.begin());
}

}  // namespace

Marginal::Marginal(const VaryOptions& options) {
  if (options.distribution == Distribution::discrete) {
    Choices choices = choices_of(options);
    const double sum = std::accumulate(choices.weights.begin(), choices.weights.end(), 0.0);
    for (double& weight : choices.weights) weight /= sum;
    law_ = openturns::library().places(choices.weights);
    values_ = std::move(choices.values);
    words_ = std::move(choices.words);
    return;
  }
  if (options.distribution == Distribution::draws) {
    draws_ = options.values;
    std::ranges::sort(draws_);
    return;
  }
  law_ = continuous(options);
}

double Marginal::quantile(double p) const {
  if (!draws_.empty()) return quantile_of_draws(draws_, p);
  const double value = law_->quantile(p);
  return values_.empty() ? value : values_.at(static_cast<std::size_t>(std::lround(value)));
}

double Marginal::mean() const {
  if (!draws_.empty()) return spread_of(draws_).mean;
  if (values_.empty()) return law_->mean();
  double sum = 0;
  for (std::size_t i = 0; i < values_.size(); ++i) sum += values_[i] * law_->density(static_cast<double>(i));
  return sum;
}

double Marginal::deviation() const {
  if (!draws_.empty()) return spread_of(draws_).deviation;
  if (values_.empty()) return law_->deviation();
  const double middle = mean();
  double sum = 0;
  for (std::size_t i = 0; i < values_.size(); ++i)
    sum += (values_[i] - middle) * (values_[i] - middle) * law_->density(static_cast<double>(i));
  return std::sqrt(sum);
}

std::vector<double> Marginal::levels(int count) const {
  if (!values_.empty()) return values_;
  std::vector<double> levels;
  for (int k = 0; k < count; ++k) levels.push_back(quantile((k + 0.5) / count));
  return levels;
}

std::shared_ptr<const openturns::Copula> copula_of(const std::vector<VaryOptions>& vary,
                                                   const std::vector<CorrelationOptions>& correlations) {
  if (correlations.empty()) return {};
  std::vector<openturns::RankCorrelation> ranks;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::string listed;
  for (const CorrelationOptions& one : correlations) {
    const auto a = place_of_key(vary, one.keys.at(0)), b = place_of_key(vary, one.keys.at(1));
    if (!pairs.emplace(std::minmax(a, b)).second)
      throw RecipeError({fmt::format("[[ensemble.correlation]] of {} and {} is there twice", one.keys[0], one.keys[1]),
                         "one would hide the other", "Leave one of them out"});
    ranks.push_back({a, b, one.rank_correlation});
    listed +=
        fmt::format("{}{} and {}: {:g}", listed.empty() ? "" : "; ", one.keys[0], one.keys[1], one.rank_correlation);
  }
  auto copula = openturns::library().copula(vary.size(), ranks);
  if (copula == nullptr)
    throw RecipeError({"[[ensemble.correlation]]: the correlations contradict one another (" + listed + ")",
                       "what goes with a third goes with its companions: their matrix is not positive definite",
                       "Make some of them smaller, or give those that are missing between the same keys"});
  return copula;
}

}  // namespace talus::preprocess
