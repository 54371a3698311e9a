// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A2: a cantilever bent far by a load at its tip.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

constexpr double length = 10, depth = 1, lift = 10, modulus = 1e9;

struct Beam {
  double h = 0.2;    // cells [m]
  int per_cell = 4;  // points along each side of a cell
  std::string shape = "quadratic";
  double k = 3.6;
  int steps = 20;
  double point_spacing() const { return h / per_cell; }
  /// Clamp to the points that are pulled.
  double arm() const { return length - 0.5 * point_spacing(); }
  double load() const { return k * modulus * depth * depth * depth * depth / 12 / (arm() * arm()); }
};

Overrides overrides_of(const Beam& b) {
  const double s = b.point_spacing();
  const auto cells = [&](double metres) { return std::lround(metres / b.h); };
  return grid_of(b.h, b.per_cell) +
         Overrides{
             {"preprocess.laboratory.cells[0]", whole(cells(length) + 8)},
             {"preprocess.laboratory.cells[1]", whole(cells(depth) + 8)},
             {"solve.shape", words(b.shape)},
             {"solve.implicit.step_s", 1.0 / b.steps},
             {"solve.load[0].extent_m", std::vector<double>{length - 0.9 * s, 0, length, depth, lift, lift + depth}},
             {"solve.load[0].force_N", std::vector<double>{0, 0, -b.load()}}};
}

/// Points of one cross-section, by their place at the start: mean of their place in a later frame.
struct Sections {
  std::vector<double> start, x, w;  // w: deflection with the load
};

Sections sections_of(const Outcome& o, const Points& then) {
  std::map<long, std::array<double, 4>> sums;
  for (std::size_t p = 0; p < o.first().size(); ++p) {
    const double at = o.first().position[p][0];
    auto& s = sums[std::lround(at * 1e4)];
    s[0] += 1;
    s[1] += at;
    s[2] += then.position[p][0];
    s[3] += o.first().position[p][2] - then.position[p][2];
  }
  Sections result;
  for (const auto& [key, s] : sums) {
    result.start.push_back(s[1] / s[0]);
    result.x.push_back(s[2] / s[0]);
    result.w.push_back(s[3] / s[0]);
  }
  return result;
}

std::string name_of(const Beam& b, const std::string& scheme) {
  return fmt::format("{}, h = {:g} m, k = {:g}, {}", b.shape, b.h, b.k, scheme);
}

/// The frame in which the load, which grows with time, has reached k; null where the run did not get there.
const Points* frame_at(const Outcome& o, const Beam& b, double k) {
  if (!o.ok()) return nullptr;
  for (const Points& frame : o.frames)
    if (std::abs(frame.time - k / b.k) < 1e-6) return &frame;
  return nullptr;
}

/// Adds the rows of load k and returns w/L: against the elastica (the goal), and against a beam that shears and
/// stretches, to which the solid converges; at this depth it bends 0.6 % (k = 1) to 1.4 % (k = 10) further.
double judge(Bench& bench, const Outcome& outcome, const Beam& b, double k, double tolerance) {
  const Points* frame = frame_at(outcome, b, k);
  const double deflection = frame ? sections_of(outcome, *frame).w.back() / b.arm() : nothing;
  const std::string at = k == b.k ? "" : fmt::format(", k = {:g}", k);
  bench.compare(outcome, "tip deflection" + at, deflection, elastica(k).across, tolerance);
  bench.compare(outcome, "tip deflection, beam with shear" + at, deflection,
                solid_beam(k, depth / b.arm(), Law::corotated).across, tolerance);
  return deflection;
}

double bend(Bench& bench, const Beam& b, const LinearScheme& scheme, double tolerance) {
  return judge(bench, bench.run(name_of(b, scheme.name), overrides_of(b) + scheme.overrides), b, b.k, tolerance);
}

/// The outermost points of the beam's near face: its outline, which hides no other.
bool on_outline(const std::array<double, 3>& start, const Beam& b) {
  const double s = b.point_spacing();
  const bool near = start[1]<s, low = start[2]<lift + s, high = start[2]> lift + depth - s, end = start[0]> length - s;
  return near && (low || high || end);
}

/// The outline of the bent beam and the axis that the closed form gives it.
void add_shape(Chart& chart, const Outcome& o, const Beam& b, double k, int colour) {
  constexpr int places = 60;
  AxisPoint axis[places];
  solid_beam(k, depth / b.arm(), Law::corotated, axis, places);
  Series exact{chart.series.empty() ? "beam with shear and stretch" : "", {}, {}, 0};
  for (const AxisPoint& a : axis) {
    exact.add(a.x * b.arm(), -a.w * b.arm());
  }
  exact.width = 2;
  chart.series.push_back(exact);
  const Points* bent = frame_at(o, b, k);
  if (!bent) return;
  Series points = marks_of(fmt::format("k = {:g}", k), colour, 2.5);
  for (std::size_t p = 0; p < bent->size(); ++p) {
    if (!on_outline(o.first().position[p], b)) continue;
    const auto& place = bent->position[p];
    points.add(place[0], place[2] - lift - 0.5 * depth);
  }
  chart.series.push_back(points);
}

Chart deflection_chart() {
  Chart chart = plain_chart("A2: tip deflection over load", "k = P L² / (E I)", "w / L");
  chart.x = Limits{0, 10.5};
  chart.y = Limits{0, 0.9};
  Series thin{"elastica", {}, {}, 0}, solid{"beam with shear and stretch", {}, {}, 7};
  solid.dashed = true;
  for (int n = 0; n <= 52; ++n) {
    const double k = 0.2 * n;
    thin.add(k, k == 0 ? 0 : elastica(k).across);
    solid.add(k, k == 0 ? 0 : solid_beam(k, depth / length, Law::corotated).across);
  }
  chart.series = {thin, solid};
  return chart;
}

/// w/L for several loads on one grid, passed as the load grows to k = 10 in 50 steps, and the deflected beams.
void load_study(Bench& bench, Beam b, double tolerance, Chart& curve, int colour) {
  b.k = 10;
  b.steps = 50;
  Chart beams =
      plain_chart(fmt::format("A2: deflected beams, {} functions, h = {:g} m, {} load steps", b.shape, b.h, b.steps),
                  "x [m]", "z [m]");
  beams.equal_scales = true;
  beams.x = Limits{-0.5, 11};
  beams.y = Limits{-9, 1};
  const LinearScheme& scheme = linear_schemes().back();
  const Outcome outcome =
      bench.run(name_of(b, scheme.name),
                overrides_of(b) + Overrides{{"solve.frame_interval_s", 1.0 / b.steps}} + scheme.overrides);
  Series s = marks_of(fmt::format("{}, h = {:g} m", b.shape, b.h), colour, 7);
  int next = 1;
  for (const double k : {1.0, 2.0, 3.0, 3.6, 5.0, 8.0, 10.0}) {
    s.add(k, judge(bench, outcome, b, k, tolerance));
    add_shape(beams, outcome, b, k, next++);
  }
  curve.series.push_back(s);
  bench.picture(fmt::format("A2-beams-{}-{:g}", b.shape, b.h), png_of_panels({beams}));
}

/// Error at k = 3.6 over cell size, 2 x 2 x 2 points per cell (the paper's Fig. 10).
void refinement(Bench& bench, const std::vector<double>& cells) {
  Chart chart = log_chart("A2: error of the tip deflection over cell size, k = 3.6, 8 points per cell", "cell size [m]",
                          "error against the beam with shear and stretch");
  int colour = 1;
  for (const char* shape : {"quadratic", "gimp", "linear"}) {
    Series error{shape, {}, {}, colour++};
    for (const double size : cells) {
      Beam b;
      b.h = size;
      b.per_cell = 2;
      b.shape = shape;
      // Tolerance: the error of hats in bending, (h / depth)^2 / 2, and as much for the clamp.
      const double tolerance = std::max(0.01, size * size);
      const double deflection =
          bend(bench, b, linear_schemes()[size < 0.2 ? 0 : 1], tolerance);  // factors of the finest fill memory
      error.add(size, std::abs(deflection / solid_beam(b.k, depth / b.arm(), Law::corotated).across - 1));
    }
    chart.series.push_back(convergence(error));
    if (chart.series.size() == 1) chart.series.push_back(slope_line(2, error));
  }
  bench.picture("A2-convergence", png_of(chart));
}

}  // namespace

/// Error of the tip deflection over the points along a side of a cell, and over the load steps (against twice as many
/// as the most; of fewer than ten the solver makes ten, nothing moving by more than a cell), h = 0.2 m, k = 3.6.
void cantilever_studies(Bench& bench) {
  Chart points = log_chart("A2: error over points per cell, h = 0.2 m, k = 3.6, 20 load steps",
                           "distance of the points over cell size", "error against the beam with shear and stretch");
  Chart steps = log_chart("A2: error over load steps, h = 0.2 m, k = 3.6, 8 points per cell",
                          "share of the load in a step", "difference to 160 load steps");
  const auto tip = [&](const Beam& b, const std::string& name) {
    const Outcome o =
        bench.run(fmt::format("{}, {}", b.shape, name), overrides_of(b) + linear_schemes().front().overrides);
    const Points* frame = frame_at(o, b, b.k);
    const double deflection = frame ? sections_of(o, *frame).w.back() / b.arm() : nothing;
    bench.note(o, "tip deflection", deflection);
    return deflection;
  };
  int colour = 1;
  for (const char* shape : {"quadratic", "gimp", "linear"}) {
    Beam b;
    b.shape = shape;
    Series error{shape, {}, {}, colour}, difference{shape, {}, {}, colour};
    ++colour;
    for (const int per_cell : {2, 3, 4, 5}) {
      b.per_cell = per_cell;
      const double exact = solid_beam(b.k, depth / b.arm(), Law::corotated).across;
      error.add(1.0 / per_cell,
                std::abs(tip(b, fmt::format("{} points per cell", per_cell * per_cell * per_cell)) / exact - 1));
    }
    points.series.push_back(convergence(error));
    b.per_cell = 2;
    b.steps = 160;
    const double finest = tip(b, "160 load steps");
    for (const int count : {10, 20, 40, 80}) {
      b.steps = count;
      difference.add(1.0 / count, std::abs(tip(b, fmt::format("{} load steps", count)) / finest - 1));
    }
    steps.series.push_back(convergence(difference));
  }
  bench.picture("A2-points", png_of(points));
  bench.picture("A2-steps", png_of(steps));
}

void cantilever(Bench& bench) {
  refinement(bench, bench.complete() ? std::vector<double>{0.5, 0.25, 0.2, 0.125, 0.1} : std::vector<double>{0.5});
}

void cantilever_loads(Bench& bench) {
  Chart curve = deflection_chart();
  int colour = 1;
  for (const double h : {0.2, 0.1}) {
    for (const char* shape : {"quadratic", "linear"}) {
      Beam b;
      b.shape = shape;
      b.h = h;
      load_study(bench, b, h > 0.15 ? 0.01 : 0.003, curve, colour++);  // validation.md A2
    }
  }
  for (std::size_t s = 0; s + 1 < linear_schemes().size(); ++s) bend(bench, Beam{}, linear_schemes()[s], 0.01);
  bench.picture("A2-deflection", png_of(curve));
}

}  // namespace talus::validation
