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

ReleaseNumbers from_map(const RunMaps& maps, double limit) {
  const auto cosine = slope_cosine({maps.grid, maps.terrain});
  const double area = maps.grid.cell * maps.grid.cell;
  ReleaseNumbers release;
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    const double h = maps.initial_thickness[i];
    if (!(h > 0)) continue;
    release.volume_if_normal += h * area / cosine[i];
    release.thickest = std::max(release.thickest, h);
    release.thickest_normal = std::max(release.thickest_normal, h * cosine[i]);
    if (!(h > limit)) continue;
    release.area += area;
    release.true_area += area / cosine[i];
  }
  return release;
}

}  // namespace

ReleaseNumbers release_numbers(const Run& run, double limit) {
  const RunSummary& s = run.summary;
  const auto if_normal = fact(s, "volume_if_thickness_were_slope_normal_m3"),
             area = fact(s, "released_area_projected_m2"), true_area = fact(s, "released_area_true_m2"),
             thickest = fact(s, "max_thickness_vertical_m"), normal = fact(s, "max_thickness_slope_normal_m");
  if (!if_normal || !area || !true_area || !thickest || !normal) return from_map(run.maps, limit);
  return {*if_normal, *area, *true_area, *thickest, *normal};
}

}  // namespace talus::postprocess
