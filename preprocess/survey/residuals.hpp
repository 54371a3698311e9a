// What is said of the misfit on stable ground.
#pragma once

#include <cstddef>
#include <vector>

namespace talus::preprocess {

/// Of residuals [m].
struct Residuals {
  double median = 0, nmad = 0, rmse = 0, median_absolute = 0;
  std::size_t count = 0;
};
Residuals residuals_of(const std::vector<double>& values);

}  // namespace talus::preprocess
