// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What OpenTURNS computes for the sensitivity. Its headers compile slowly: statistics.cpp alone includes them.
#pragma once

#include <cstddef>
#include <vector>

namespace talus::postprocess {

/// Sobol indices of each input with their 95 % intervals.
struct SobolIndices {
  std::vector<double> first, first_low, first_high;
  std::vector<double> total, total_low, total_high;
};

/// By Saltelli's estimators (2002, equations 14 and 18). `inputs`: a list of [size (d + 2)] values for each of d
/// inputs, whose rows are the sample A, the sample B, and for each input A with that input's values of B. `outputs`
/// likewise.
SobolIndices sobol_indices(const std::vector<std::vector<double>>& inputs, const std::vector<double>& outputs,
                           std::size_t size);

/// Spearman's rank correlation of each input with the output.
std::vector<double> rank_correlations(const std::vector<std::vector<double>>& inputs,
                                      const std::vector<double>& outputs);

/// Standardised coefficients of a linear regression of the output's ranks on the inputs'. Empty where inputs depend on
/// one another linearly.
std::vector<double> rank_regression(const std::vector<std::vector<double>>& inputs, const std::vector<double>& outputs);

}  // namespace talus::postprocess
