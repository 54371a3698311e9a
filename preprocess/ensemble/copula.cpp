// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/copula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "common/error.hpp"

namespace talus::preprocess {
namespace {

std::size_t place_of_key(const std::vector<VaryOptions>& vary, const std::string& key) {
  const auto found = std::find_if(vary.begin(), vary.end(), [&](const VaryOptions& one) { return one.key == key; });
  return static_cast<std::size_t>(found - vary.begin());
}

}  // namespace

std::shared_ptr<const openturns::Copula> copula_of(const std::vector<VaryOptions>& vary,
                                                   const std::vector<CorrelationOptions>& correlations) {
  if (correlations.empty()) return {};
  std::vector<openturns::RankCorrelation> ranks;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::string listed;
  for (const CorrelationOptions& one : correlations) {
    const auto a = place_of_key(vary, one.keys.at(0)), b = place_of_key(vary, one.keys.at(1));
    if (!pairs.emplace(std::minmax(a, b)).second)
      throw RecipeError(
          Fault{fmt::format("[[ensemble.correlation]] of {} and {} is there twice", one.keys[0], one.keys[1]),
                "one would hide the other", "Leave one of them out"});
    ranks.push_back({a, b, one.rank_correlation});
    listed +=
        fmt::format("{}{} and {}: {:g}", listed.empty() ? "" : "; ", one.keys[0], one.keys[1], one.rank_correlation);
  }
  auto copula = openturns::library().copula(vary.size(), ranks);
  if (copula == nullptr)
    throw RecipeError(Fault{"[[ensemble.correlation]]: the correlations contradict one another (" + listed + ")",
                            "what goes with a third goes with its companions: their matrix is not positive definite",
                            "Make some of them smaller, or give those that are missing between the same keys"});
  return copula;
}

}  // namespace talus::preprocess
