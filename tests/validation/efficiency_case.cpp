// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A4: time and memory of a step over the number of points, and the share of its parts (Tables 3, 4, Figs 14, 15).
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"

namespace talus::validation {
namespace {

constexpr double h = 0.01, step = 5e-5;

struct Scheme {
  std::string name;
  Overrides overrides;
  double paper_time;                      // per point and step [s]
  std::vector<int> quick, complete, gpu;  // thickness in cells; `gpu`: beyond the paper's sizes
};

std::vector<Scheme> schemes() {
  const Overrides explicit_steps{{"solve.preset", words("none")},  {"solve.integrator", words("explicit")},
                                 {"solve.shape", words("linear")}, {"solve.transfer", words("flip")},
                                 {"solve.transfer_time_s", 1e30},  {"solve.stress_update", words("musl")},
                                 {"solve.largest_step_s", step},   {"solve.cfl", 0.8}};
  return {{"PCG", {{"solve.implicit.linear_solver", words("pcg")}}, 2e-7, {1, 2}, {1, 2, 4, 8, 16, 32}, {128}},
          {"Cholesky", {{"solve.implicit.linear_solver", words("cholesky")}}, 5e-6, {1, 2}, {1, 2, 4, 8}, {16}},
          {"explicit", explicit_steps, 1.6e-8, {1, 2}, {1, 2, 4, 8, 16, 32}, {128}}};
}

Overrides thick(int cells, int steps) {
  return {{"preprocess.laboratory.cells[1]", whole(cells + 7)},
          {"preprocess.box[0].extent_m[3]", cells * h},
          {"solve.wall[2].position_m", cells * h},
          {"solve.end_time_s", steps * step}};
}

/// Share of every phase of a step over the number of points.
std::string shares(const std::string& name, const std::vector<Outcome>& runs) {
  Chart chart = plain_chart(fmt::format("A4: share of each part of a step, {}", name), "material points",
                            "share of the time [%]");
  chart.log_x = true;
  chart.y = Limits{0, 100};
  std::map<std::string, Series> parts;
  int colour = 1;
  for (const Outcome& o : runs) {
    for (const auto& [phase, seconds] : o.run.summary.profile) {
      if (phase == "records and frames") continue;
      Series& s = parts.try_emplace(phase, marked_line(phase, colour)).first->second;
      if (s.x.empty()) ++colour;
      s.add(static_cast<double>(o.run.summary.particles), 100 * seconds / o.run.summary.wall_time);
    }
  }
  for (const auto& [phase, series] : parts) chart.series.push_back(series);
  return png_of(chart);
}

std::vector<int> sizes_of(const Bench& bench, const Scheme& scheme) {
  std::vector<int> sizes = bench.complete() ? scheme.complete : scheme.quick;
  if (bench.complete() && bench.on_gpu()) sizes.insert(sizes.end(), scheme.gpu.begin(), scheme.gpu.end());
  return sizes;
}

/// What a scheme costs over the number of points, and the runs that tell its phases.
struct SchemeLines {
  Series eta, bytes, paper;
  std::vector<Outcome> profiled;
};

SchemeLines lines_of(const Scheme& scheme, int colour) {
  SchemeLines l{marked_line(scheme.name, colour),
                marked_line(scheme.name, colour),
                {scheme.name + ", paper (RTX 3060 Ti)", {}, {}, colour},
                {}};
  l.paper.dashed = true;
  return l;
}

/// Time and memory of one size.
void time_size(Bench& bench, const Scheme& scheme, int cells, SchemeLines& lines) {
  const int steps = bench.complete() ? 200 : 10;
  const std::string variant = fmt::format("{}, {} points, {} steps", scheme.name, 36288 * cells, steps);
  const Overrides overrides = thick(cells, steps) + scheme.overrides;
  const Outcome o = bench.run(variant, overrides);
  const RunSummary& s = o.run.summary;
  const double points = static_cast<double>(s.particles), each = s.wall_time / (points * static_cast<double>(s.steps));
  bench.note(o, "time per point and step [s]", each);
  bench.note(o, "memory [GB]", s.memory / 1e9);
  if (!o.ok()) return;
  lines.eta.add(points, each);
  lines.bytes.add(points, s.memory / 1e9);
  lines.paper.add(points, scheme.paper_time);
  if (cells > 32) return;
  // Once more with its phases: waiting for each of them would count in the time above.
  Outcome phases = bench.run(variant + ", profile", overrides, true);
  if (phases.ok()) lines.profiled.push_back(std::move(phases));
}

}  // namespace

void step_cost(Bench& bench) {
  Chart time = log_chart("A4: time per point and step", "material points", "time per point and step [s]"),
        memory = log_chart("A4: memory of points, grid and linear solver", "material points", "memory [GB]");
  int colour = 1;
  for (const Scheme& scheme : schemes()) {
    SchemeLines lines = lines_of(scheme, colour++);
    for (const int cells : sizes_of(bench, scheme)) time_size(bench, scheme, cells, lines);
    time.series.push_back(lines.eta);
    if (lines.paper.x.size() > 1) time.series.push_back(lines.paper);
    memory.series.push_back(lines.bytes);
    bench.picture("A4-shares-" + scheme.name, shares(scheme.name, lines.profiled));
  }
  bench.picture("A4-time", png_of(time));
  bench.picture("A4-memory", png_of(memory));
}

}  // namespace talus::validation
