// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How a result settles as members are added.
#pragma once

#include <cstdint>
#include <vector>

namespace talus::postprocess {

/// Mean of the first n members that have a value, and its standard error s / sqrt(n), for growing n.
struct Convergence {
  std::vector<std::int64_t> members;
  std::vector<double> mean, error;  ///< the error is NaN of one member
};

/// Of values in the order of the members, NaN left out; at most `points` steps, evenly spread, the last with all.
Convergence convergence(const std::vector<double>& values, std::size_t points);

}  // namespace talus::postprocess
