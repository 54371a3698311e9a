// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/styles.hpp"

#include "postprocess/fields/classes.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {

std::vector<double> pressure_limits(const std::vector<double>& values) {
  return fitting_limits({1, 3, 5, 10, 100, 1000, 10000}, largest(values), 4, 7);
}

std::vector<double> speed_limits(const std::vector<double>& values) {
  return fitting_limits({0.5, 1, 5, 10, 25, 50, 100}, largest(values), 1);
}

std::vector<double> thickness_limits(const std::vector<double>& given, const std::vector<double>& values) {
  return class_limits(given, largest(values));
}

std::vector<double> time_limits(const std::vector<double>& values) {
  const double last = largest(values);
  if (!(last > 0)) return {1};
  double step = round_below(last / 3);
  if (last / step > 7) step *= 2;
  std::vector<double> limits;
  for (int i = 1; i <= 6 && i * step < last; ++i) limits.push_back(i * step);
  return limits;
}

std::vector<double> map_limits(const MapField& field, const RunMaps& maps, const std::vector<double>& given_classes) {
  const std::vector<double>& values = maps.*(field.values);
  switch (field.product.classes) {
    case MapClasses::pressure: return pressure_limits(values);
    case MapClasses::speed: return speed_limits(values);
    case MapClasses::time: return time_limits(values);
    case MapClasses::share: return {0.1, 0.25, 0.5, 0.75, 1};
    case MapClasses::thickness: break;
  }
  return thickness_limits(given_classes, values);
}

RasterStyle map_style(const std::string& name, const RunMaps& maps, const std::vector<double>& given_classes) {
  if (name.starts_with("difference")) return difference_style(thickness_limits({}, maps.deposit_thickness), "m");
  const bool of_a_release = name.starts_with("deposit_thickness");
  const MapField& field = map_field(of_a_release ? std::string_view("deposit_thickness") : name);
  const std::vector<double> limits = map_limits(field, maps, given_classes);
  switch (field.product.classes) {
    case MapClasses::pressure: return class_style(limits, "kPa");
    case MapClasses::speed: return class_style(limits, "m/s", Ramp::sea);
    case MapClasses::time: return time_style(limits, "s");
    case MapClasses::share: return class_style(limits, "", Ramp::sea);
    case MapClasses::thickness: break;
  }
  return class_style(limits, "m");
}

}  // namespace talus::postprocess
