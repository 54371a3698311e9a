// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/products.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "solver/run/thickness.hpp"

namespace talus::solver {
namespace {

double total_volume(const ParticleState& points) {
  return std::accumulate(points.volume.begin(), points.volume.end(), 0.0);
}

/// This function adds a map of what each release left, and takes out of the others what was ground at the start or
/// still is at the end.
void separate_releases(const RunEnd& run, RunMaps& maps) {
  const Domain& domain = run.domain;
  const ParticleState &end = run.state.points, &start = run.scene.points;
  const auto map_of = [&](const ParticleState& s, const std::function<bool(std::size_t)>& counts) {
    return thickness_of(run.scene, run.options, s, counts);
  };
  const std::vector<std::string>& names = run.scene.release_names;
  for (std::size_t r = 0; r < names.size(); ++r) {
    maps.deposit_of.emplace_back(names[r], map_of(end, [&](std::size_t p) {
                                   return end.release[p] == static_cast<int>(r) && belongs_to_slide(run, p);
                                 }));
  }
  if (domain.erodible == 0) return;
  maps.initial_thickness = map_of(start, [&](std::size_t p) { return start.release[p] >= domain.erodible; });
  maps.deposit_thickness = map_of(end, [&](std::size_t p) { return belongs_to_slide(run, p); });
  const auto layer = map_of(start, [&](std::size_t p) { return start.release[p] < domain.erodible; });
  const auto left = map_of(end, [&](std::size_t p) { return !belongs_to_slide(run, p); });
  for (std::size_t c = 0; c < layer.size(); ++c) {
    maps.eroded_depth.push_back(std::max(0.0, layer[c] - left[c]));
    maps.peak_thickness[c] = std::max(0.0, maps.peak_thickness[c] - layer[c]);
  }
}

}  // namespace

bool belongs_to_slide(const RunEnd& end, std::size_t p) {
  const ParticleState &s = end.state.points, &start = end.scene.points;
  if (s.release[p] >= end.domain.erodible) return true;
  const auto first = static_cast<std::size_t>(s.id[p]);
  const auto moved = [&](int a) {
    return s.cell[a][p] + s.offset[a][p] - start.cell[a][first] - start.offset[a][first];
  };
  return std::hypot(moved(0), moved(1)) > 1;
}

SlideVolumes slide_volumes(const RunEnd& end, double outflow) {
  const ParticleState &s = end.state.points, &start = end.scene.points;
  SlideVolumes volumes;
  volumes.released = end.scene.inflow.volume(end.pulses);
  if (end.domain.erodible == 0) {
    volumes.released += total_volume(start);
    volumes.final = total_volume(s);
    return volumes;
  }
  for (std::size_t p = 0; p < start.size(); ++p) {
    if (start.release[p] >= end.domain.erodible) volumes.released += start.volume[p];
  }
  for (std::size_t p = 0; p < s.size(); ++p) {
    if (belongs_to_slide(end, p)) volumes.final += s.volume[p];
  }
  volumes.entrained = volumes.final + outflow - volumes.released;
  return volumes;
}

RunMaps final_maps(const RunEnd& end, std::vector<double> thickness) {
  RunMaps maps;
  maps.grid = end.scene.map;
  maps.terrain = end.domain.terrain.values;
  maps.before = end.domain.before.values;
  maps.initial_thickness = end.initial_thickness;
  maps.deposit_thickness = std::move(thickness);
  for_each_running_map(
      [&](const RunningMap& map, const std::vector<double>& kept) {
        for (const double value : kept)
          (maps.*(map.result)).push_back(value < 0 ? std::numeric_limits<double>::quiet_NaN() : value / map.unit);
      },
      end.state.maps);
  if (end.scene.release_names.size() > 1) separate_releases(end, maps);
  maps.threshold = end.options.map_threshold;
  return maps;
}

}  // namespace talus::solver
