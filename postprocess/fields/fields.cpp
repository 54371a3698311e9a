#include "postprocess/fields/fields.hpp"

#include <cmath>
#include <limits>

namespace talus::postprocess {

const std::vector<Field>& product_fields() {
  static const std::vector<Field> fields = {
      {"deposit_thickness", &RunMaps::deposit_thickness, "m", "deposit thickness at the end, vertical", "area: mean",
       true},
      {"peak_thickness", &RunMaps::peak_thickness, "m", "peak thickness, vertical", "area: mean time: maximum", true},
      {"peak_speed", &RunMaps::peak_speed, "m s-1", "peak of the depth-mean speed", "time: maximum", true},
      {"peak_pressure", &RunMaps::peak_pressure, "kPa", "peak flow pressure, density times speed squared",
       "time: maximum", true},
      {"arrival_time", &RunMaps::arrival_time, "s", "time from the start to the first arrival", "", false},
  };
  return fields;
}

std::vector<char> inside_domain(const RunMaps& maps) {
  std::vector<char> inside(maps.grid.count());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    inside[i] = std::isfinite(maps.terrain[i]) || maps.deposit_thickness[i] > 0 || maps.peak_thickness[i] > 0;
  }
  return inside;
}

Raster field_raster(const RunMaps& maps, const Field& field) {
  return values_raster(maps, maps.*(field.values), field.zero_inside);
}

Raster values_raster(const RunMaps& maps, const std::vector<double>& values, bool zero_inside) {
  Raster raster{maps.grid, values};
  const auto inside = inside_domain(maps);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i])
      raster.values[i] = std::numeric_limits<double>::quiet_NaN();
    else if (zero_inside && std::isnan(raster.values[i]))
      raster.values[i] = 0;
  }
  return raster;
}

std::string file_word(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    if (!plain) c = '-';
  }
  return word;
}

double volume_under(const std::vector<double>& thickness, double cell) {
  long double sum = 0;
  for (const double h : thickness) {
    if (std::isfinite(h)) sum += h;
  }
  return static_cast<double>(sum * static_cast<long double>(cell) * static_cast<long double>(cell));
}

}  // namespace talus::postprocess
