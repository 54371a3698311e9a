// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is left between simulation and survey, measured by the survey's own error.
#pragma once

#include <cstddef>
#include <vector>

namespace talus::postprocess {

/// The normalised residual r = (simulated - surveyed) / sigma over some cells. NaN where there is no cell.
struct Residual {
  std::size_t cells = 0;
  double median = 0;
  double within = 0;       ///< share of the cells with |r| <= 1.96; 0.95 where the survey's error is all there is
  double chi_squared = 0;  ///< mean of r^2: 1 where the survey's error is all there is (no parameter is fitted)
};

/// Over the cells where `counts` holds and sigma is positive; a NaN in any of the three leaves a cell out.
Residual residual_of(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                     const std::vector<double>& sigma, const std::vector<char>& counts);

}  // namespace talus::postprocess
