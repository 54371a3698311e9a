// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The classes of a difference, the same on the map and in its legend.
#pragma once

#include <vector>

#include "postprocess/compare/compare.hpp"

namespace talus::postprocess {

/// Lower limits of the sizes that are told apart [m]: 1, 2, 5, 10, 20 and 50 fiftieths of the largest, rounded.
std::vector<double> difference_limits(const DepositDifference& found);

}  // namespace talus::postprocess
