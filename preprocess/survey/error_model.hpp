// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the difference of two surveys is worth: its standard deviation cell by cell, and that of volumes.
#pragma once

#include <vector>

#include "preprocess/survey/variogram.hpp"

namespace talus::preprocess {

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

}  // namespace talus::preprocess
