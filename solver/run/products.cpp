// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/products.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "solver/integrator/point_sums.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {
namespace {

double total_volume(const ParticleState& points) {
  return std::accumulate(points.volume.begin(), points.volume.end(), 0.0);
}

/// Adds a map of what each release left, and takes out of the others what was ground at the start or is at the end.
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

/// Whether something but gravity does work on the mass: loads, shaking, and walls that move.
bool work_is_done(const SolveOptions& o) {
  return !o.loads.empty() || o.shaking.acts() ||
         std::any_of(o.walls.begin(), o.walls.end(), [](const WallOptions& wall) { return wall.speed != 0; });
}

double largest(const RunHistory& history, const char* name) {
  const HistoryColumn* column = history.find(name);
  if (!column || column->values.empty()) return RunSanity::unknown;
  return *std::max_element(column->values.begin(), column->values.end());
}

/// The largest rise of kinetic, potential and elastic energy together from any earlier record, over what was turned
/// over: the fall of the potential energy and the largest sum of the others. What flows out takes energy along.
double energy_gain(const RunHistory& history) {
  const auto& kinetic = history.at("kinetic_J").values;
  const auto& potential = history.at("potential_J").values;
  const auto& elastic = history.at("elastic_J").values;
  if (kinetic.empty()) return RunSanity::unknown;
  const HistoryColumn* const inflow = history.find("inflow_energy_J");
  // Of what enters, the energy that it had then counts as none: what it falls from there on is turned over.
  const auto height = [&](std::size_t n) { return potential[n] - (inflow ? inflow->values[n] : 0); };
  double least = 1e300, rise = 0, stored = 0, deepest = height(0);
  for (std::size_t n = 0; n < kinetic.size(); ++n) {
    const double held = kinetic[n] + elastic[n], sum = held + height(n);
    least = std::min(least, sum);
    rise = std::max(rise, sum - least);
    stored = std::max(stored, held);
    deepest = std::min(deepest, height(n));
  }
  const double turned = stored + height(0) - deepest;
  return turned > 0 ? rise / turned : 0;
}

/// The speed of a fall without loss [m/s], from the point that stands highest against gravity at the start, or when it
/// enters, to the lowest ground that the mass has reached.
double speed_of_fall(const RunEnd& end) {
  const SolveOptions& o = end.options;
  const auto height = [&](double x, double y, double z) {
    return -(o.gravity[0] * x + o.gravity[1] * y + o.gravity[2] * z);
  };
  double top = -1e300, low = 1e300;
  for (const auto& [x, y, z] : positions(end.scene, end.scene.points)) top = std::max(top, height(x, y, z));
  const ParticleState& entering = end.scene.inflow.points;
  double start = o.initial_speed();
  for (const auto& [x, y, z] : positions(end.scene, entering)) top = std::max(top, height(x, y, z));
  for (std::size_t p = 0; p < entering.size(); ++p)
    start = std::max(start, std::hypot(entering.velocity[0][p], entering.velocity[1][p], entering.velocity[2][p]));
  const MapGrid& map = end.scene.map;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double ground = end.domain.terrain.at(column, row);
      if (end.state.maps.peak_thickness[map.index(column, row)] > 0 && std::isfinite(ground))
        low = std::min(low, height(map.x(column), map.y(row), ground));
    }
  }
  return std::sqrt(start * start + 2 * std::max(0.0, top - low));
}

}  // namespace

std::vector<double> thickness_of(const Scene& scene, const SolveOptions& options, const ParticleState& points,
                                 const std::function<bool(std::size_t)>& counts) {
  const GridShape& shape = scene.grid;
  std::vector<double> thickness(static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows), 0.0);
  Particles<double, CpuDevice> held(CpuDevice::make(), {.boxes = options.shape == ShapeKind::gimp});
  held.upload(points);
  with_shape(options.shape, [&](auto kind) {
    const ScatterThickness<double, decltype(kind)> scatter{held.view(), shape.columns, thickness.data()};
    for (std::size_t p = 0; p < points.size(); ++p)
      if (counts(p)) scatter(static_cast<int>(p));
    return 0;
  });
  for (double& value : thickness) value /= shape.spacing * shape.spacing;
  return thickness;
}

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
  for (std::size_t p = 0; p < start.size(); ++p)
    if (start.release[p] >= end.domain.erodible) volumes.released += start.volume[p];
  for (std::size_t p = 0; p < s.size(); ++p)
    if (belongs_to_slide(end, p)) volumes.final += s.volume[p];
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
        if (map.result == nullptr) return;
        for (const double value : kept)
          (maps.*(map.result)).push_back(value < 0 ? std::numeric_limits<double>::quiet_NaN() : value / map.unit);
      },
      end.state.maps);
  if (end.scene.release_names.size() > 1) separate_releases(end, maps);
  maps.threshold = *with_map_threshold(end.options, end.domain).map_threshold;
  return maps;
}

RunSanity sanity_of(const RunEnd& end, const RunHistory& history, double outflow) {
  const double released = total_volume(end.scene.points) + end.scene.inflow.volume(end.pulses),
               kept = total_volume(end.state.points);
  RunSanity sanity;
  sanity.volume_error = released > 0 ? (kept + outflow) / released - 1 : 0;
  sanity.volume_left = released > 0 ? outflow / released : 0;
  sanity.packing_p99 = largest(history, "packing_p99");
  sanity.packing_max = largest(history, "packing_max");
  sanity.speed_max = largest(history, "speed_max_so_far_m_s");
  if (!work_is_done(end.options)) {
    sanity.energy_gain = energy_gain(history);
    sanity.speed_bound = speed_of_fall(end);
  }
  for (const Finding& found : insane(sanity))
    sanity.words += fmt::format("{}{}", sanity.words.empty() ? "" : "; ", found.message);
  if (sanity.words.empty()) sanity.words = "sane";
  return sanity;
}

std::vector<Finding> insane(const RunSanity& s, const SanityBounds& bounds) {
  std::vector<Finding> found;
  const auto add = [&](const char* name, std::string message, const char* number, double value, const char* unit) {
    found.push_back({Severity::warning, name, std::move(message), {{number, value, unit}}});
  };
  if (std::abs(s.volume_error) > bounds.volume_error)
    add("volume-error", fmt::format("volume is off by {:.2g} of what was there at the start", s.volume_error),
        "volume_error", s.volume_error, "1");
  if (s.volume_left > bounds.volume_left)
    add("volume-left-domain",
        fmt::format("{:.0f} % of the volume left the domain: the maps show the rest", 100 * s.volume_left),
        "volume_left", s.volume_left, "1");
  if (s.packing_p99 > bounds.packing_p99)
    add("dense-packing",
        fmt::format("a hundredth of the volume was packed {:.2f} times and denser: points have drifted together "
                    "within cells, or a soft mass was squashed",
                    s.packing_p99),
        "packing_p99", s.packing_p99, "1");
  if (s.energy_gain > bounds.energy_gain)
    add("energy-gain",
        fmt::format("the energy rose by {:.2g} of what was turned over, though nothing did work", s.energy_gain),
        "energy_gain", s.energy_gain, "1");
  if (s.speed_max > bounds.speed_share * s.speed_bound)
    add("faster-than-fall",
        fmt::format("a point ran at {:.4g} m/s, and a fall without loss to where the mass came gives "
                    "{:.4g} m/s",
                    s.speed_max, s.speed_bound),
        "speed_max", s.speed_max, "m s-1");
  return found;
}

void say_sanity(const RunSanity& s) {
  const auto or_none = [](double value, const std::string& text) { return std::isfinite(value) ? text : "unknown"; };
  log_info(fmt::format(
      "sanity: volume error {:.1e}, {:.2g} of it left; packing {} for 99 % of the volume, {} at most; energy gain {}; "
      "fastest point {}, fall without loss {}: {}",
      s.volume_error, s.volume_left, or_none(s.packing_p99, fmt::format("{:.2f}", s.packing_p99)),
      or_none(s.packing_max, fmt::format("{:.2f}", s.packing_max)),
      or_none(s.energy_gain, fmt::format("{:.1e}", s.energy_gain)),
      or_none(s.speed_max, fmt::format("{:.1f} m/s", s.speed_max)),
      or_none(s.speed_bound, fmt::format("{:.1f} m/s", s.speed_bound)), s.words));
  for (Finding& found : insane(s)) add_finding(std::move(found));
}

}  // namespace talus::solver
