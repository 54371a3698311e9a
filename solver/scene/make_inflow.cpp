// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/make_inflow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/machine.hpp"

namespace talus::solver {
namespace {

constexpr double fastest_inflow = 100;          ///< of a debris flow or an avalanche [m/s]
constexpr double bytes_per_inflow_point = 300;  ///< of its fields, in two lists for a moment

/// The largest flow of an inflow; one that cannot be is refused.
InflowSummary largest_flow(const InflowOptions& o, const std::string& place, const Hydrograph& hydrograph,
                           const InflowSection& section) {
  InflowSummary found;
  found.peak = hydrograph.peak();
  if (!(found.peak > 0))
    throw DataError({place + ": all discharges are 0", "nothing would enter", "Give a hydrograph, or leave it out"});
  const SectionFlow flow = section.flow(found.peak);
  found.width = flow.width;
  found.depth = flow.depth;
  found.speed = flow.speed * section.along();
  found.froude = section.froude(flow);
  if (flow.depth > flow.width)
    throw DataError({fmt::format("{}: {:.4g} m3/s would stand {:.3g} m deep over {:.3g} m of its line", place,
                                 found.peak, flow.depth, flow.width),
                     "a flow deeper than wide is no flow down a channel: the line is too short for the discharge",
                     o.depth ? "Give a smaller depth_m, or a longer line"
                             : "Give a longer line, a larger speed_m_s or froude, or less discharge"});
  if (found.speed > fastest_inflow)
    throw DataError({fmt::format("{}: {:.4g} m3/s through {:.3g} m2 would enter at {:.3g} m/s", place, found.peak,
                                 flow.area, found.speed),
                     fmt::format("no flow is faster than {:g} m/s", fastest_inflow),
                     "Give a larger depth_m, a longer line, or less discharge"});
  return found;
}

/// The number of the material that [[solve.part]] gives to a release of this name; 0: that of [solve.material].
int material_called(const SolveOptions& options, const std::string& name) {
  for (std::size_t part = 0; part < options.parts.size(); ++part)
    if (options.parts[part].release == name) return static_cast<int>(part) + 1;
  return 0;
}

/// An inflow as it is before there are points.
struct Entrance {
  std::string place;  ///< in messages
  Hydrograph hydrograph;
  InflowLine line;
  InflowSection section;
  InflowSummary summary;  ///< of its largest flow
};

Entrance entrance_of(const Domain& domain, const SolveOptions& options, std::size_t number,
                     const InflowTerrain& terrain) {
  const InflowOptions& o = options.inflows[number];
  const std::string place = fmt::format("[[solve.inflow]] name = \"{}\"", inflow_name(o, number));
  Hydrograph hydrograph = read_hydrograph(o, place);
  InflowLine line = inflow_line(o, place, domain.grid, terrain);
  line.ground.gravity = options.gravity_size();
  InflowSection section(line.ground, o);
  InflowSummary summary = largest_flow(o, place, hydrograph, section);
  summary.name = inflow_name(o, number);
  const auto spells = hydrograph.spells();
  summary.from = spells.front().first;
  summary.to = std::min(spells.back().second, options.end_time);
  summary.volume = hydrograph.volume_until(options.end_time);
  summary.late_volume = hydrograph.volume_until(hydrograph.end()) - summary.volume;
  return {place, std::move(hydrograph), std::move(line), std::move(section), std::move(summary)};
}

/// Refuses more points than can be.
void require_countable(const Entrance& e, const InflowOptions& o, std::size_t pulses, const Domain& domain) {
  const double cells = e.line.ground.strip * static_cast<double>(e.line.middles.size()) / domain.grid.cell *
                       std::max(1.0, e.summary.depth / domain.layer_height);
  const double most = static_cast<double>(pulses) * cells * o.points_per_cell[1] * o.points_per_cell[2];
  const std::string what = fmt::format("{}: up to {:.3g} material points would enter", e.place, most);
  const std::string mend = "Take larger cells or layers, fewer points_per_cell, or an earlier end_time_s";
  if (most + static_cast<double>(domain.points.size()) > std::numeric_limits<int>::max())
    throw DataError({what, "points are numbered in 32 bits", mend});
  require_memory(bytes_per_inflow_point * most, what, mend);
}

/// The top of an inflow over the deepest place of its line.
InflowTop top_of(const Entrance& e, const Domain& domain) {
  double lowest = std::numeric_limits<double>::infinity();  // ground, from which heights of sections are measured [m]
  for (const double z : domain.terrain.values)
    if (std::isfinite(z)) lowest = std::min(lowest, z);
  const auto& height = e.line.ground.height;
  const auto deepest = static_cast<std::size_t>(std::min_element(height.begin(), height.end()) - height.begin());
  const CellPlace& at = e.line.middles[deepest];
  return {.x = domain.grid.west + (at[0] + 0.5) * domain.grid.cell,
          .y = domain.grid.south + (at[1] + 0.5) * domain.grid.cell,
          .z = lowest + height[deepest] + e.summary.depth,
          .speed = e.summary.speed};
}

/// The points of one inflow.
Inflow make_one(const Domain& domain, const SolveOptions& options, std::size_t number, const InflowTerrain& terrain) {
  const InflowOptions& o = options.inflows[number];
  const Entrance e = entrance_of(domain, options, number, terrain);
  const double way = terrain.shape.spacing / o.points_per_cell[0];
  const std::vector<PulseTimes> times = pulse_times(e.hydrograph, e.section, way, options.end_time);
  require_countable(e, o, times.size(), domain);
  const InflowSeeder seeder(e.line, e.section, terrain,
                            {.release = static_cast<int>(domain.release_names.size() + number),
                             .material = material_called(options, e.summary.name),
                             .density = options.material_of(e.summary.name).density,
                             .gravity = options.gravity_vector(),
                             .points_per_cell = {o.points_per_cell[0], o.points_per_cell[1], o.points_per_cell[2]}});
  Inflow inflow;
  for (const PulseTimes& pulse : times) seeder.add(pulse, e.place, inflow);
  inflow.summaries.push_back(e.summary);
  inflow.tops.push_back(top_of(e, domain));
  return inflow;
}

/// The pulses of all inflows in the order of their times.
Inflow merged(const std::vector<Inflow>& all, std::size_t seeded) {
  struct Turn {
    const Inflow* from;
    const InflowPulse* pulse;
  };
  Inflow merged;
  std::vector<Turn> turns;
  for (const Inflow& one : all) {
    for (const InflowPulse& pulse : one.pulses) turns.push_back({&one, &pulse});
    merged.summaries.insert(merged.summaries.end(), one.summaries.begin(), one.summaries.end());
    merged.tops.insert(merged.tops.end(), one.tops.begin(), one.tops.end());
  }
  std::ranges::stable_sort(turns, [](const Turn& a, const Turn& b) { return a.pulse->time < b.pulse->time; });
  for (const auto& [from, pulse] : turns) {
    InflowPulse own = *pulse;
    own.first = merged.points.size();
    append_points(merged.points, from->points, pulse->first, pulse->count);
    for (std::size_t p = pulse->first; p < pulse->first + pulse->count; ++p) {
      merged.line_x.push_back(from->line_x[p]);
      merged.line_y.push_back(from->line_y[p]);
    }
    merged.pulses.push_back(own);
  }
  for (std::size_t p = 0; p < merged.points.size(); ++p) merged.points.id[p] = static_cast<int>(seeded + p);
  return merged;
}

}  // namespace

Inflow make_inflow(const Domain& domain, const SolveOptions& options, const GridShape& shape,
                   const TerrainTables& terrain) {
  std::vector<Inflow> all;
  for (std::size_t n = 0; n < options.inflows.size(); ++n)
    all.push_back(make_one(domain, options, n, {shape, terrain}));
  return merged(all, domain.points.size());
}

}  // namespace talus::solver
