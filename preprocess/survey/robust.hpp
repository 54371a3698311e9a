// Statistics that a few wild values do not move.
#pragma once

#include <vector>

namespace talus::preprocess {

/// The middle one; the mean of the two middle ones of an even count. NaN of nothing.
double median(std::vector<double> values);

/// Normalised median absolute deviation, 1.4826 median(|v - median(v)|): the standard deviation of a normal
/// distribution, whatever the tails are (Hoehle & Hoehle 2009, Tab. 2). NaN of nothing.
double nmad(const std::vector<double>& values);

/// What is said of residuals [m].
struct Residuals {
  double median = 0, nmad = 0, rmse = 0, median_absolute = 0;
  std::size_t count = 0;
};
Residuals residuals_of(const std::vector<double>& values);

}  // namespace talus::preprocess
