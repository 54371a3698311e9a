// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One step of an alignment: what the misfit of stable cells says of the shift that is left.
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

/// Rows of at most half a million stable cells, evenly taken; tilts are counted as the rise over `length` [m], so that
/// all unknowns are of one size.
ShiftRows rows_of(const std::vector<Patch>& patches, const Placement& placement, double length);

/// A fit of shift, height and tilt.
struct ShiftFit {
  std::array<double, 5> value{};  // 0 for what was not sought [m]
  std::array<double, 5> error{};  // standard errors, cells taken as independent
};

/// Least squares for the unknowns sought, with Tukey's biweights (cut at 4.685 NMAD, which keeps 95 % of the
/// efficiency), reweighted five times.
ShiftFit fit_shift(const ShiftRows& rows, const std::vector<int>& sought);

/// Slopes must differ along every direction, else a shift along the one in which they do not cannot be found.
bool tells_a_shift(const ShiftRows& rows);

}  // namespace talus::preprocess
