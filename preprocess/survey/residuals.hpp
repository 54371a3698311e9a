// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of the misfit on stable ground.
#pragma once

#include <cstddef>
#include <vector>

namespace talus::preprocess {

/// How residuals are spread [m].
struct Residuals {
  double median = 0, nmad = 0, rmse = 0, median_absolute = 0;
  std::size_t count = 0;
};
/// Count, median, NMAD and median size of the values [m]; NaN is left out.
Residuals residuals_of(const std::vector<double>& values);

}  // namespace talus::preprocess
