#include "postprocess/report/limits.hpp"

#include <algorithm>
#include <cmath>

#include "postprocess/picture/view.hpp"

namespace talus::postprocess {
namespace {

/// 1, 2 or 5 times a power of ten that is at least `value`.
double round_above(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= value * (1 - 1e-12)) return step * power;
  }
  return 10 * power;
}

}  // namespace

std::vector<double> speed_limits(double fastest) {
  if (fastest > 60) return {1, 5, 10, 25, 50, 100};
  return {0.5, 1, 5, 10, 25, 50};
}

std::vector<double> pressure_limits(double largest) {
  if (largest <= 100) return {1, 3, 5, 10, 25, 50};
  std::vector<double> limits{1};
  for (double power = 10; power < largest && limits.size() < 7; power *= 10) {
    limits.push_back(power);
    if (5 * power < largest) limits.push_back(5 * power);
  }
  return limits;
}

std::vector<double> time_limits(double latest) {
  if (!(latest > 0)) return {};
  const double step = round_below(latest / 5);  // five to ten classes
  std::vector<double> limits;
  for (int k = 1; k * step < latest && k < 10; ++k) limits.push_back(k * step);
  return limits;
}

std::vector<double> difference_limits(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences)
    if (std::abs(d) > 0) sizes.push_back(std::abs(d));
  if (sizes.empty()) return {0.2, 0.5, 1};
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1 - sizes.size() / 50);
  std::nth_element(sizes.begin(), place, sizes.end());
  const double scale = round_above(std::max(*place, 0.1));
  return {scale / 5, scale / 2, scale};
}

}  // namespace talus::postprocess
