// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of an alignment: what the misfit of stable cells says of the shift that is left.
#pragma once

#include <array>
#include <vector>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

inline constexpr double biweight_cut = 4.685;  ///< scales, beyond which a cell does not count

/// Numbers of the unknowns in the rows.
enum ShiftUnknown { shift_x, shift_y, shift_z, tilt_x, tilt_y };

/// What each stable cell says: misfit = row * unknowns.
struct ShiftRows {
  std::vector<std::array<double, 5>> row;
  std::vector<double> misfit;  // [m]
};

/// Rows of at most half a million stable cells, evenly taken; tilts as the rise over `length` [m], for one size of all.
ShiftRows rows_of(const std::vector<Patch>& patches, const Placement& placement, double length);

struct ShiftFit {
  std::array<double, 5> value{};  // 0 for what was not sought [m]
  std::array<double, 5> error{};  // standard errors, cells taken as independent
};

/// Least squares with Tukey's biweights (cut at 4.685 NMAD, which keeps 95 % of the efficiency), reweighted five times.
ShiftFit fit_shift(const ShiftRows& rows, const std::vector<int>& sought);

/// Slopes must differ along every direction, else a shift along the one in which they do not cannot be found.
bool tells_a_shift(const ShiftRows& rows);

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
