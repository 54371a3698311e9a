// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The distribution of one key that varies, and how keys vary together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/ensemble/openturns.hpp"
#include "common/ensemble/options.hpp"

namespace talus::preprocess {

/// A distribution as [[ensemble.vary]] describes it. Of words, the values are their places in words().
class Marginal {
 public:
  /// Throws RecipeError where no such distribution exists: nothing is left between low and high, a deviation that does
  /// not go with the mean; and DataError as read_density() does.
  explicit Marginal(const VaryOptions& options);

  /// The value that a share 0 < p < 1 lies below.
  double quantile(double p) const;
  double mean() const;       ///< of what is left where it is cut off
  double deviation() const;  ///< likewise
  /// What full-grid and one-at-a-time take: the quantiles (k + 1/2) / count, of a discrete one all its values.
  std::vector<double> levels(int count) const;
  /// The words that it chooses from; empty: numbers.
  const std::vector<std::string>& words() const { return words_; }

 private:
  openturns::AnyLaw law_;       // none where there are draws
  std::vector<double> values_;  // of a discrete one, growing
  std::vector<double> draws_;   // growing
  std::vector<std::string> words_;
};

/// The normal copula with Spearman's rank correlations between keys, whose order `vary` gives; none where no keys vary
/// together. Throws RecipeError where their matrix is not positive definite, or one pair is there twice.
std::shared_ptr<const openturns::Copula> copula_of(const std::vector<VaryOptions>& vary,
                                                   const std::vector<CorrelationOptions>& correlations);

}  // namespace talus::preprocess
