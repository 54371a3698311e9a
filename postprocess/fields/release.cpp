// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/release.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "common/map/slope.hpp"

namespace talus::postprocess {

namespace {

std::optional<double> fact(const RunSummary& summary, std::string_view name) {
  for (const auto& [key, value] : summary.provenance) {
    double number = 0;
    if (key != name) continue;
    if (std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc()) return number;
  }
  return std::nullopt;
}

}  // namespace

ReleaseNumbers numbers_of(const Raster& thickness, const std::vector<double>& cosine, double limit) {
  const double area = thickness.grid.cell * thickness.grid.cell;
  ReleaseNumbers numbers;
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    const double h = thickness.values[i];
    if (!(h > 0)) continue;
    numbers.volume_if_normal += h * area / cosine[i];
    numbers.thickest = std::max(numbers.thickest, h);
    numbers.thickest_normal = std::max(numbers.thickest_normal, h * cosine[i]);
    if (!(h > limit)) continue;
    numbers.area += area;
    numbers.true_area += area / cosine[i];
  }
  return numbers;
}

ReleaseNumbers release_numbers(const Run& run, double limit) {
  const RunSummary& s = run.summary;
  const auto if_normal = fact(s, "volume_if_thickness_were_slope_normal_m3"),
             area = fact(s, "released_area_projected_m2"), true_area = fact(s, "released_area_true_m2"),
             thickest = fact(s, "max_thickness_vertical_m"), normal = fact(s, "max_thickness_slope_normal_m");
  const MapGrid& grid = run.maps.grid;
  if (!if_normal || !area || !true_area || !thickest || !normal)
    return numbers_of({grid, run.maps.initial_thickness}, slope_cosine({grid, run.maps.terrain}), limit);
  return {*if_normal, *area, *true_area, *thickest, *normal};
}

}  // namespace talus::postprocess
