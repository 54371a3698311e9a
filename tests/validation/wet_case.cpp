// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// E1 and E2: flows full of water, against measurements.
#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "tests/validation/chart.hpp"
#include "tests/validation/map_scene.hpp"
#include "tests/validation/sand.hpp"

namespace talus::validation {
namespace {

// E1 ---------------------------------------------------------------------------------------------------------------

/// The times after the front has passed `first_ring` at which it is compared, at 1 g; with N times gravity they are the
/// sqrt(N)th part [s].
constexpr double first_ring = 0.07, times[] = {0.1, 0.2};  // [m], [s]

/// Tests of one kind: what stood on the tray, and the front of the grains (Webb 2024), the median of the tests.
struct Tests {
  double bead;  // [m]
  const char* fluid;
  double gravity;          // [g]
  double viscosity;        // of the fluid [Pa s]
  double density, grains;  // of fluid and grains [kg/m3]
  double tension;          // of the fluid's surface [N/m]
  double solid;            // fraction [-]
  double front[2];         // at `times` [m]
  double end;              // of its track [m]
};
constexpr Tests tests[] = {{0.002, "water", 1, 1.02e-3, 1000, 2632, 0.0725, 0.606, {0.099, 0.119}, 0.127},
                           {0.004, "water", 1, 1.05e-3, 1000, 2662, 0.0725, 0.601, {0.098, 0.118}, 0.131},
                           {0.002, "glycerol", 1, 32.4e-3, 1191, 2632, 0.0658, 0.606, {0.079, 0.083}, 0.092},
                           {0.004, "glycerol", 1, 32.4e-3, 1191, 2662, 0.0658, 0.601, {0.089, 0.099}, 0.106},
                           {0.002, "water", 4.61, 1.00e-3, 1000, 2632, 0.0725, 0.606, {0.112, 0.154}, 0.193},
                           {0.004, "water", 4.61, 1.01e-3, 1000, 2662, 0.0725, 0.601, {0.112, 0.154}, 0.178},
                           {0.002, "glycerol", 4.61, 5.05e-3, 1120, 2632, 0.0683, 0.606, {0.106, 0.143}, 0.172},
                           {0.004, "glycerol", 4.61, 5.12e-3, 1120, 2662, 0.0683, 0.601, {0.108, 0.143}, 0.194},
                           {0.002, "glycerol", 14.03, 16.1e-3, 1167, 2632, 0.0667, 0.606, {0.106, 0.146}, 0.199},
                           {0.004, "glycerol", 14.03, 15.9e-3, 1167, 2662, 0.0667, 0.601, {0.110, 0.149}, 0.199},
                           {0.002, "glycerol", 28.08, 32.1e-3, 1189, 2632, 0.0659, 0.606, {0.105, 0.141}, 0.207},
                           {0.004, "glycerol", 28.08, 32.1e-3, 1189, 2662, 0.0659, 0.601, {0.110, 0.150}, 0.207}};

/// The repeats of 4 mm in water at 1 g end between 107 and 143 mm: a quarter of their run-out either way.
constexpr double scatter = 0.25;

/// The suction at which air enters between spheres, times their diameter over the surface tension (Haines 1927) [-].
constexpr double entry = 6;

/// The depth of a deposit whose last ring is half covered by beads, over their diameter [-].
constexpr double half_covered = 0.5;

/// How far from the axis rings of a map, a cell wide each, are deeper than that on average [m].
double front_of_rings(const MapGrid& grid, const std::vector<double>& depths, double depth) {
  std::vector<double> sums(static_cast<std::size_t>(grid.columns + grid.rows)), counts = sums;
  each_cell(grid, [&](int column, int row) {
    if (grid.x(column) < 0 || grid.y(row) < 0) return;
    const auto ring = static_cast<std::size_t>(std::hypot(grid.x(column), grid.y(row)) / grid.cell);
    const double here = depths[grid.index(column, row)];
    sums[ring] += std::isfinite(here) ? here : 0;
    ++counts[ring];
  });
  std::size_t last = sums.size() - 2;
  const auto mean = [&](std::size_t ring) { return counts[ring] > 0 ? sums[ring] / counts[ring] : 0; };
  while (last > 0 && mean(last) < depth) --last;
  const double into = (mean(last) - depth) / (mean(last) - mean(last + 1));
  return (static_cast<double>(last) + 0.5 + into) * grid.cell;
}

/// The front of the grains over the time since it passed `first_ring`, as at 1 g.
Series track_of(const Outcome& o, const Tests& t) {
  Series track;
  for (std::size_t n = 0; n < o.run.frames.time.size(); ++n)
    track.add(o.run.frames.time[n] * std::sqrt(t.gravity),
              front_of_rings(o.run.maps.grid, o.run.frames.thickness[n], half_covered * t.bead));
  std::size_t n = 1;
  while (n + 1 < track.x.size() && track.y[n] < first_ring) ++n;
  const double passed =
      track.x[n - 1] + (track.x[n] - track.x[n - 1]) * (first_ring - track.y[n - 1]) / (track.y[n] - track.y[n - 1]);
  for (double& time : track.x) time -= passed;
  return track;
}

double at(const Series& track, double time) {
  for (std::size_t n = 1; n < track.x.size(); ++n) {
    if (track.x[n] < time) continue;
    const double share = (time - track.x[n - 1]) / (track.x[n] - track.x[n - 1]);
    return track.y[n - 1] + share * (track.y[n] - track.y[n - 1]);
  }
  return nothing;
}

Overrides overrides_of(const Tests& t, const Sand& s) {
  constexpr double standard = 9.81, frame = 0.02, end = 0.5;  // [m/s2], [s] at 1 g
  const double scale = std::sqrt(t.gravity);
  return round_column(s) + Overrides{{"preprocess.laboratory.cells", std::vector<std::int64_t>{88, 88}},
                                     {"solve.gravity_m_s2", std::vector<double>{0, 0, -standard * t.gravity}},
                                     {"solve.end_time_s", end / scale},
                                     {"solve.frame_interval_s", frame / scale},
                                     {"solve.history_interval_s", frame / scale},
                                     {"solve.material.density_kg_m3", t.solid * t.grains + (1 - t.solid) * t.density},
                                     {"solve.material.youngs_modulus_Pa", 1e6 * t.gravity},
                                     {"solve.water.grain_diameter_m", t.bead},
                                     {"solve.water.solid_fraction", t.solid},
                                     {"solve.water.fluid_density_kg_m3", t.density},
                                     {"solve.water.viscosity_Pa_s", t.viscosity},
                                     {"solve.water.suction_Pa", entry * t.tension / t.bead}};
}

// E2 ---------------------------------------------------------------------------------------------------------------

/// The bed of the flume: 31 degrees, an arc from 78 m on, and 2.5 degrees. Distances along the bed from the gate [m].
struct Flume {
  static constexpr double steep = 31 * degree, pad = 2.5 * degree, straight = 78, radius = 10,
                          arc = radius * (steep - pad);
  static double x(double s) {
    if (s <= straight) return s * std::cos(steep);
    const double turned = std::min(s - straight, arc) / radius;
    return straight * std::cos(steep) + radius * (std::sin(steep) - std::sin(steep - turned)) +
           std::max(s - straight - arc, 0.0) * std::cos(pad);
  }
  static double z(double s) {
    if (s <= straight) return -s * std::sin(steep);
    const double turned = std::min(s - straight, arc) / radius;
    return -straight * std::sin(steep) - radius * (std::cos(steep - turned) - std::cos(steep)) -
           std::max(s - straight - arc, 0.0) * std::sin(pad);
  }
  /// The place along the bed of an x, by bisection.
  static double along(double x_wanted) {
    double low = -20, high = 150;
    for (int n = 0; n < 60; ++n) (x((low + high) / 2) < x_wanted ? low : high) = (low + high) / 2;
    return (low + high) / 2;
  }
  /// The vertical depth of what stands behind the gate, its outline along and across the bed.
  static double depth(double x_at) {
    constexpr double outline[][2] = {{-4.7, 0}, {-4.18, 0.83}, {-0.98, 1.63}, {0, 0}};
    double most = 0;
    for (int part = 0; part < 250; ++part) {  // up a vertical line, into the outline and out of it
      const double h = 0.005 + 0.01 * part, s = x_at / std::cos(steep) - h * std::sin(steep), n = h * std::cos(steep);
      for (int k = 0; k < 3; ++k) {
        const auto &a = outline[k], &b = outline[k + 1];
        if (s < a[0] || s >= b[0]) continue;
        if (n < a[1] + (b[1] - a[1]) * (s - a[0]) / (b[0] - a[0])) most += 0.01;
      }
    }
    return most;
  }
};

}  // namespace

void debris_flow_flume(Bench& bench) {
  MapGrid grid;
  grid.cell = 0.1;
  grid.columns = 1080;
  grid.rows = 40;
  grid.west = -8;
  grid.south = -2;
  const Raster ground = at_centres(grid, [](double x, double) { return 100 + Flume::z(Flume::along(x)); });
  const Raster prism =
      cell_means(grid, [](double x, double y) { return std::abs(y) < 1 && x < 0.5 ? Flume::depth(x) : 0; });
  const Outcome o = bench.run("9.9 m3", write_scene(bench, "flume", ground, prism));
  if (!o.ok()) return;
  for (const double s : {2.0, 32.0, 66.0, 80.0, 90.0}) {
    const RunMaps& maps = o.run.maps;
    const auto column = static_cast<int>((Flume::x(s) - maps.grid.west) / maps.grid.cell),
               row = static_cast<int>(-maps.grid.south / maps.grid.cell);
    const std::size_t n = maps.grid.index(column, row);
    bench.note(o, fmt::format("at {:g} m: arrival [s]", s), maps.arrival_time[n]);
    bench.note(o, fmt::format("at {:g} m: largest depth, vertical [m]", s), maps.peak_thickness[n]);
    bench.note(o, fmt::format("at {:g} m: largest pore pressure over load", s), maps.peak_pore_pressure[n]);
  }
}

void wet_columns(Bench& bench) {
  const Sand s{.h = 0.054 / 16, .per_cell = 2, .height = 0.05, .width = 0.054};
  const auto picture_of = [](const char* beads) {
    return plain_chart(fmt::format("E1: front of beads of {}, marks measured (Webb 2024)", beads),
                       "time since 70 mm, times sqrt(N) [s]", "front of the grains [m]");
  };
  Chart pictures[] = {picture_of("2 mm"), picture_of("4 mm")};
  double in_water[2] = {nothing, nothing};  // last front at 1 g
  for (const Tests& t : tests) {
    const int larger = t.bead > 0.003 ? 1 : 0;
    const std::string name = fmt::format("{:g} mm in {} at {:g} g", 1000 * t.bead, t.fluid, t.gravity);
    const Outcome o = bench.run(name, overrides_of(t, s));
    if (!o.ok()) continue;
    Series track = track_of(o, t);
    track.name = fmt::format("{}, {:g} g", t.fluid, t.gravity);
    track.colour = static_cast<int>(pictures[larger].series.size()) / 2 + 1;
    Series measured = marks_of("", track.colour, 9);
    for (std::size_t n = 0; n < std::size(times); ++n) {
      measured.add(times[n], t.front[n]);
      bench.compare(o, fmt::format("run-out {:g} s later, over sqrt(N)", times[n]), at(track, times[n]) - s.width,
                    t.front[n] - s.width, scatter);
    }
    if (t.gravity > 1) {
      bench.note(o, "last front over that of the track", track.y.back() / t.end);
    } else {
      bench.compare(o, "run-out at the end", track.y.back() - s.width, t.end - s.width, scatter);
      const bool in_glycerol = std::string_view(t.fluid) == "glycerol";
      if (in_glycerol)
        bench.compare(o, "last front over that in water", track.y.back() / in_water[larger], t.end / tests[larger].end,
                      0.2);
      else
        in_water[larger] = track.y.back();
    }
    for (const Series& series : {track, measured}) pictures[larger].series.push_back(series);
  }
  bench.picture("E1-fronts-2-mm", png_of(pictures[0]));
  bench.picture("E1-fronts-4-mm", png_of(pictures[1]));
}

}  // namespace talus::validation
