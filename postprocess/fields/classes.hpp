// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness classes of the picture and of the styles beside the maps; their colours are those of common/map/colours.
#pragma once

#include <vector>

#include "common/map/colours.hpp"

namespace talus::postprocess {

/// Lower limits of classes that fit values up to `largest`: those of `ladder` (the thresholds of a field's usual maps,
/// rising) that are exceeded, of which the lowest `kept` and the highest ones make `most` at most; with finer ones (1,
/// 2, 5 times a power of ten) below where they would be fewer than four. `largest` not above 0: the first four.
std::vector<double> fitting_limits(const std::vector<double>& ladder, double largest, std::size_t kept,
                                   std::size_t most = 6);

/// Lower limits of thickness classes [m]: as given; if none are, of 0.1|0.5|1|2|5|10|25|50|100|200|500 those that fit.
std::vector<double> class_limits(const std::vector<double>& given, double thickest);

/// Largest of the positive values, NaN left out; 0 if there is none.
double largest(const std::vector<double>& values);

/// Index of the class that holds the value; -1 below the first limit or for NaN.
int class_of(double value, const std::vector<double>& limits);

/// A round number (1, 2 or 5 times a power of ten) that is at most `limit`.
double round_below(double limit);

}  // namespace talus::postprocess
