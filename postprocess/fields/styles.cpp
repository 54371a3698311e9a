#include "postprocess/fields/styles.hpp"

#include <algorithm>

#include "postprocess/fields/classes.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) {
    if (v > most) most = v;  // NaN is not
  }
  return most;
}

}  // namespace

std::vector<double> pressure_limits(const RunMaps& maps) {
  std::vector<double> limits{1, 3, 5, 10};
  for (const double more : {100.0, 1000.0, 10000.0}) {
    if (largest(maps.peak_pressure) > more) limits.push_back(more);
  }
  return limits;
}

std::vector<double> speed_limits(const RunMaps& maps) {
  std::vector<double> limits{0.5, 1, 5, 10, 25, 50};
  if (largest(maps.peak_speed) > 100) limits.push_back(100);
  return limits;
}

std::vector<double> thickness_limits(const std::vector<double>& given, const std::vector<double>& values) {
  return class_limits(given, largest(values));
}

std::vector<double> time_limits(const RunMaps& maps) {
  const double last = largest(maps.arrival_time);
  if (!(last > 0)) return {1};
  double step = round_below(last / 3);
  if (last / step > 7) step *= 2;
  std::vector<double> limits;
  for (int i = 1; i <= 6 && i * step < last; ++i) limits.push_back(i * step);
  return limits;
}

RasterStyle map_style(const std::string& name, const RunMaps& maps, const std::vector<double>& given_classes) {
  if (name == "peak_pressure") return class_style(pressure_limits(maps), "kPa");
  if (name == "peak_speed") return class_style(speed_limits(maps), "m/s", Ramp::sea);
  if (name.starts_with("difference")) return difference_style(thickness_limits({}, maps.deposit_thickness), "m");
  if (name == "arrival_time") return time_style(time_limits(maps), "s");
  const auto& values = name == "peak_thickness" ? maps.peak_thickness
                       : name == "eroded_depth" ? maps.eroded_depth
                                                : maps.deposit_thickness;  // and what single releases left of it
  return class_style(thickness_limits(given_classes, values), "m");
}

}  // namespace talus::postprocess
