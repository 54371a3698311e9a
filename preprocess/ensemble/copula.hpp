// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that vary together: a normal copula by OpenTURNS.
#pragma once

#include <memory>
#include <vector>

#include "common/ensemble/options.hpp"

namespace talus::preprocess {

/// A normal copula with Spearman's rank correlations between keys.
class Copula {
 public:
  /// `vary` gives the order of the keys. Throws RecipeError where no such correlations can be together (their matrix is
  /// not positive definite), or where one pair is there twice.
  Copula(const std::vector<VaryOptions>& vary, const std::vector<CorrelationOptions>& correlations);

  /// Whether any keys vary together.
  bool acts() const { return acts_; }
  /// The method makes independent shares 0 < u < 1, one for each key, into shares that go together, by conditional
  /// quantiles (Rosenblatt 1952). The first key keeps its own.
  void bind(std::vector<double>& shares) const;

 private:
  struct Law;
  std::shared_ptr<const Law> law_;
  bool acts_ = false;
};

}  // namespace talus::preprocess
