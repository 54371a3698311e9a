// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How alike the errors of neighbouring cells are, and what that does to a mean over many.
#pragma once

#include <vector>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// Shares of the variance (their sum is 1): without correlation, and correlated over a shorter and a longer range by
/// the spherical model 1 - 1.5 h/r + 0.5 (h/r)^3.
struct Variogram {
  double nugget = 1, short_sill = 0, short_range = 0, long_sill = 0, long_range = 0;  // ranges in m
  std::vector<double> lags, semivariance;  // the empirical one, of the normalised misfit

  /// Correlation of two cells `lag` metres apart.
  double correlation(double lag) const;

  /// Variance of the mean over an area [m2] of cells of `cell` metres, over the variance of one cell: the correlation
  /// integrated over the disc of that area (Rolstad et al. 2009, J. Glaciol. 55, 666, eq. 8 to 10), and the nugget as
  /// independent cells.
  double of_mean(double area, double cell) const;

  /// Range of the one spherical model, without nugget, with the same variance of a mean over `area` [m]; 0 where cells
  /// err independently.
  double equivalent_range(double area, double cell) const;
};

/// The variogram of the misfit on stable ground, each cell's over its own standard deviation: semivariance after Dowd
/// (1984), 2.198 median|a - b|^2 / 2, in fifteen classes of distance from a cell to half a patch, 4,000 random pairs in
/// each; nugget and sills by non-negative least squares for the best range, or the best two where the second halves
/// what is left. `normalised` has a vector for every patch, NaN where not stable. A pure nugget where there are too few
/// cells. Same data, same result.
Variogram variogram_of(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& normalised);

}  // namespace talus::preprocess
