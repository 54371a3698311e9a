// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The error of the elevation models, as it might have been: another random field for each member.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/ensemble/options.hpp"
#include "common/map/fourier.hpp"
#include "preprocess/scene/read_scene.hpp"

namespace talus::preprocess {

/// Errors of the ground and of the released thickness, Gaussian, with a standard deviation at each cell and a spherical
/// correlation, or a sum of them. As the survey stage finds them on stable ground (from_survey): the deviation of the
/// difference by slope is that of the released thickness; the ground's is that over the root of two; nugget and ranges
/// are those of the variogram, each less what its mean over a cell of the working grid loses where that is wider than
/// the survey's.
class ElevationErrors {
 public:
  /// `base` is the scene whose errors they are. Throws RecipeError where from_survey finds no survey, or one whose
  /// error is not known, and where boxes of a laboratory have no surveyed thickness.
  ElevationErrors(const ElevationErrorOptions& options, const Options& of_base, const SceneRasters& base, int seed);

  /// The method adds a member's errors: the ground's to bed and surface alike; the other to the released thickness
  /// where there is any, which stays at or above 0, the surface before following it. Fields depend on the seed and the
  /// member alone. For several threads at once.
  void apply(SceneRasters& scene, std::int64_t member) const;

  /// The deviations and ranges, as people read them.
  std::string words() const;

 private:
  struct Part {
    double share;  ///< of the variance
    double range;  ///< [m]; 0: cells err independently
    RandomField field;
  };
  void take_survey(const SceneRasters& base);
  void add_part(const MapGrid& grid, double share, double range);
  void add_thickness(SceneRasters& scene, const std::vector<double>& field) const;

  std::vector<double> terrain_, thickness_;  // deviations [rows * columns], or one for all cells [m]; empty: none
  std::vector<Part> parts_;
  std::uint64_t seed_;
};

}  // namespace talus::preprocess
