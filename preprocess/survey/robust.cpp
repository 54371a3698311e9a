#include "preprocess/survey/robust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus::preprocess {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double nmad(const std::vector<double>& values) {
  const double centre = median(values);
  std::vector<double> deviations(values.size());
  std::transform(values.begin(), values.end(), deviations.begin(), [&](double v) { return std::abs(v - centre); });
  return 1.4826 * median(std::move(deviations));
}

Residuals residuals_of(const std::vector<double>& values) {
  Residuals r{median(values), nmad(values), 0, 0, values.size()};
  std::vector<double> sizes;
  double squares = 0;
  for (const double v : values) {
    sizes.push_back(std::abs(v));
    squares += v * v;
  }
  r.median_absolute = median(std::move(sizes));
  r.rmse = std::sqrt(squares / static_cast<double>(values.size()));
  return r;
}

}  // namespace talus::preprocess
