// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// A shift on the map with its standard error.
struct RefinedShift {
  bool known = false;             ///< false: the placement stays as it was
  double x = 0, y = 0;            ///< to be added to the placement's [m]
  std::array<double, 2> error{};  ///< standard errors east and north [m]
};

/// What is left of a shift that is known to part of a cell, band by band of wavelengths (see fit_bands()), on cells
/// that have not changed, are not too steep and do not stand out of the misfit by more than 4.685 NMAD. Its error is
/// the larger of two, by the noise of the bands and by the spread of what squares of the map say (an eighth of its
/// width each), with what posts too coarse for their terrain add. Not known where too few cells count, where the
/// iteration does not stand still, or where it leaves the place from which it set out by more than a cell; the error
/// then is as wide as that, and at least a cell.
RefinedShift refined_shift(const std::vector<Patch>& patches, const Placement& placement);

}  // namespace talus::preprocess
