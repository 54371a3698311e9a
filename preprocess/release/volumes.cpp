// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/volumes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/map/sum.hpp"

namespace talus::preprocess {

Volumes volumes_of(const Raster& thickness, const std::vector<double>& cosine) {
  const double cell_area = thickness.grid.cell * thickness.grid.cell;
  Volumes v;
  Sum volume, if_normal, true_area;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    const double t = thickness.values[i];
    if (!(t > 0)) continue;
    ++v.cells;
    volume.add(t);
    if_normal.add(t / cosine[i]);
    true_area.add(1 / cosine[i]);
    v.max_vertical = std::max(v.max_vertical, t);
    v.max_normal = std::max(v.max_normal, t * cosine[i]);
  }
  v.volume = volume.value() * cell_area;
  v.volume_if_normal = if_normal.value() * cell_area;
  v.projected_area = static_cast<double>(v.cells) * cell_area;
  v.true_area = true_area.value() * cell_area;
  return v;
}

std::vector<std::string> as_lines(const std::string& name, const Volumes& v) {
  return {fmt::format("{}: {} m3: vertical thickness times map area", name, grouped(v.volume)),
          fmt::format("  the same thickness taken as slope-normal would be {} m3 ({:+.1f} %)",
                      grouped(v.volume_if_normal), 100 * (v.volume_if_normal / v.volume - 1)),
          fmt::format("  area {} m2 on the map, {} m2 along the bed, {} cells", grouped(v.projected_area),
                      grouped(v.true_area), v.cells),
          fmt::format("  thickness at most {:.2f} m vertical, {:.2f} m slope-normal", v.max_vertical, v.max_normal)};
}

std::vector<std::pair<std::string, std::string>> as_facts(const Volumes& v) {
  const auto number = [](double value) { return fmt::format("{:.12g}", value); };
  return {{"released_volume_m3", number(v.volume)},
          {"volume_if_thickness_were_slope_normal_m3", number(v.volume_if_normal)},
          {"released_area_projected_m2", number(v.projected_area)},
          {"released_area_true_m2", number(v.true_area)},
          {"released_cells", std::to_string(v.cells)},
          {"max_thickness_vertical_m", number(v.max_vertical)},
          {"max_thickness_slope_normal_m", number(v.max_normal)}};
}

}  // namespace talus::preprocess
