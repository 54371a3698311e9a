// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness classes of the picture and of the styles beside the maps; their colours are those of common/map/colours.
#pragma once

#include <vector>

#include "common/map/colours.hpp"

namespace talus::postprocess {

/// Lower limits as given; if none are, those that fit what is drawn: five of 1, 2, 5 times powers of ten, the largest
/// no more than 0.8 of the thickest, and below them 0.1 m, or the next of the same numbers where that is less.
std::vector<double> class_limits(const std::vector<double>& given, double thickest);

/// Index of the class that holds the value; -1 below the first limit or for NaN.
int class_of(double value, const std::vector<double>& limits);

/// A round number (1, 2 or 5 times a power of ten) that is at most `limit`.
double round_below(double limit);

}  // namespace talus::postprocess
