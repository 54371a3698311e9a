// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/copula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <openturns/CorrelationMatrix.hxx>
#include <openturns/NormalCopula.hxx>
#include <set>
#include <utility>

#include "common/error.hpp"

namespace talus::preprocess {

struct Copula::Law {
  OT::NormalCopula copula;
};

namespace {

OT::UnsignedInteger place_of_key(const std::vector<VaryOptions>& vary, const std::string& key) {
  const auto found = std::find_if(vary.begin(), vary.end(), [&](const VaryOptions& one) { return one.key == key; });
  return static_cast<OT::UnsignedInteger>(found - vary.begin());
}

}  // namespace

Copula::Copula(const std::vector<VaryOptions>& vary, const std::vector<CorrelationOptions>& correlations) {
  if (correlations.empty()) return;
  OT::CorrelationMatrix ranks(vary.size());
  std::set<std::pair<OT::UnsignedInteger, OT::UnsignedInteger>> pairs;
  std::string listed;
  for (const CorrelationOptions& one : correlations) {
    const auto a = place_of_key(vary, one.keys.at(0)), b = place_of_key(vary, one.keys.at(1));
    if (!pairs.emplace(std::minmax(a, b)).second)
      throw RecipeError(
          Fault{fmt::format("[[ensemble.correlation]] of {} and {} is there twice", one.keys[0], one.keys[1]),
                "one would hide the other", "Leave one of them out"});
    ranks(a, b) = one.rank_correlation;
    listed +=
        fmt::format("{}{} and {}: {:g}", listed.empty() ? "" : "; ", one.keys[0], one.keys[1], one.rank_correlation);
  }
  const auto refuse = [&] {
    throw RecipeError(Fault{"[[ensemble.correlation]]: the correlations contradict one another (" + listed + ")",
                            "what goes with a third goes with its companions: their matrix is not positive definite",
                            "Make some of them smaller, or give those that are missing between the same keys"});
  };
  if (!ranks.isPositiveDefinite()) refuse();
  OT::CorrelationMatrix normal;
  try {
    normal = OT::NormalCopula::GetCorrelationFromSpearmanCorrelation(ranks);
  } catch (const OT::Exception&) {
    refuse();
  }
  if (!normal.isPositiveDefinite()) refuse();
  law_ = std::make_shared<Law>(Law{OT::NormalCopula(normal)});
  acts_ = true;
}

void Copula::bind(std::vector<double>& shares) const {
  if (!acts_) return;
  OT::Point point(shares.size());
  std::copy(shares.begin(), shares.end(), point.begin());
  const OT::Point bound = law_->copula.computeSequentialConditionalQuantile(point);
  std::copy(bound.begin(), bound.end(), shares.begin());
}

}  // namespace talus::preprocess
