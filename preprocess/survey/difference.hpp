// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// After less before, block by block, and what it is worth: its standard deviation cell by cell, how alike the errors
// of neighbouring cells are, the error of volumes.
#pragma once

#include <functional>
#include <vector>

#include "preprocess/survey/patches.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// Shares of the variance (their sum is 1): without correlation, and correlated over a shorter and a longer range by
/// the spherical model 1 - 1.5 h/r + 0.5 (h/r)^3.
struct Variogram {
  double nugget = 1, short_sill = 0, short_range = 0, long_sill = 0, long_range = 0;  // ranges in m
  std::vector<double> lags, semivariance;  // the empirical one, of the normalised misfit

  /// Correlation of two cells `lag` metres apart.
  double correlation(double lag) const;

  /// Variance of the mean over an area [m2] of cells of `cell` metres, over the variance of one cell: the correlation
  /// integrated over its disc (Rolstad et al. 2009, J. Glaciol. 55, 666, eq. 8 to 10), and independent nuggets.
  double of_mean(double area, double cell) const;

  /// Range of the spherical model without nugget of the same variance over `area` [m]; 0 where cells err independently.
  double equivalent_range(double area, double cell) const;
};

/// The variogram of the misfit on stable ground, each cell's over its own standard deviation: semivariance after Dowd
/// (1984), 2.198 median|a - b|^2 / 2, in fifteen classes of distance from a cell to half a patch, 4,000 random pairs in
/// each; nugget and sills by non-negative least squares for the best range, or the best two where the second halves
/// what is left. `normalised` has a vector for every patch, NaN where not stable. A pure nugget where there are too few
/// cells. Same data, same result.
Variogram variogram_of(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& normalised);

/// The error of after - before, learnt where nothing moved or given.
class ErrorModel {
 public:
  ErrorModel() = default;

  /// The error learnt from the misfit of the unchanged cells, steep and rough ones too: NMAD in classes of slope
  /// (steeper ground errs more; Hugonnet et al. 2022, IEEE JSTARS 15, 6456), and the variogram of the misfit over it.
  /// `given` [m] > 0 takes the place of the NMAD.
  static ErrorModel learnt(const std::vector<Patch>& patches, const Placement& placement, double given);

  /// Without stable ground: `given` alone [m], errors of cells independent.
  static ErrorModel of(double given);

  /// Standard deviation [m] on ground that rises by `slope` a metre.
  double sigma(double slope) const;

  /// Standard error of every cell of a surface, by its slope [m].
  std::vector<double> sigmas(const Raster& surface) const;

  /// Standard deviation of the mean over an area [m2] whose cells have `mean_square` [m2] as their mean variance; with
  /// what the alignment's own height is not known better than.
  double of_mean(double mean_square, double area, double cell) const;

  /// How the errors of cells are alike over distance.
  const Variogram& variogram() const { return variogram_; }
  double typical() const { return typical_; }  ///< over all stable ground [m]
  double offset() const { return offset_; }    ///< of the mean height of stable ground [m]
  /// False where nothing tells the error: it is not given, and there is no stable ground, or the models are the same on
  /// most of it (to 1 mm), as where one was made from the other. sigma() is 0 then, and of_mean() NaN.
  bool is_known() const { return known_; }
  /// The share of stable ground where both models are the same to 1 mm; two surveys never agree so.
  double same_share() const { return same_share_; }
  /// True when the recipe gives the error, so that it was not learnt.
  bool is_given() const { return given_; }

 private:
  std::vector<double> slopes_, sigmas_;  // middle of each class [-], NMAD in it [m]
  double typical_ = 0, offset_ = 0;
  double same_share_ = 0;
  bool given_ = false, known_ = false;
  Variogram variogram_;
};

/// Level of detection [m] of a difference of standard deviation `sigma`, at 95 %, two-sided; 0 where that is NaN.
double level_of_detection(double sigma);

/// One volume with the area it stands on, and its standard error.
struct VolumeWithError {
  double volume = 0, area = 0, error = 0;  // [m3], [m2], [m3]
};

/// What went down, what went up, and the balance, of all cells or of those beyond their level of detection.
struct Budget {
  VolumeWithError erosion, deposition, net;
};

/// Sums the cells of a part of the map and makes their budget.
class BudgetSum {
 public:
  /// One cell: difference and its standard deviation [m].
  void add(double difference, double sigma);
  /// The budget of all cells added so far, on cells of `cell` [m], with errors by `model`.
  Budget budget(const ErrorModel& model, double cell) const;

 private:
  struct Side {
    double sum = 0, squares = 0;
    std::size_t cells = 0;
  };
  static VolumeWithError volume(const Side& side, const ErrorModel& model, double cell);
  Side down_, up_;
  std::size_t level_ = 0;  // cells without any change
  double level_squares_ = 0;
};

/// Before, after and their difference on one block; all on its cells.
struct Block {
  Raster before, after, difference, sigma;
};

/// Walks over a grid block by block (1024 cells wide and high), reading both surveys only there. `visit` sees every
/// block once, from the south-west to the north-east.
void for_each_block(const Elevation& before, const Elevation& after, const MapGrid& grid, const ErrorModel& model,
                    const std::function<void(const Block&)>& visit);

struct Budgets {
  Budget raw, thresholded;
};

}  // namespace talus::preprocess
