// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A1 and A1b: columns under their own weight.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

/// First Piola stress of the points over their height in the first frame [Pa]. With nu = 0 and no lateral strain the
/// pressure of the file, minus the mean Kirchhoff stress, is a third of the vertical one.
std::vector<double> piola_of(const Outcome& o, const Column& column) {
  std::vector<double> piola;
  for (const float p : o.last().pressure)
    piola.push_back(column.modulus * piola_of_kirchhoff(column.law, -3.0 * static_cast<double>(p) / column.modulus));
  return piola;
}

/// Volume mean of |P - P_exact| over the stress at the foot (Charlton, Coombs & Augarde 2017, eq. 40).
double stress_error(const Outcome& o, const Column& column) {
  if (!o.ok()) return nothing;
  const auto piola = piola_of(o, column);
  double sum = 0, volume = 0;
  for (std::size_t p = 0; p < piola.size(); ++p) {
    const double v = static_cast<double>(o.first().volume[p]);
    sum += v * std::abs(piola[p] - column.piola(o.first().position[p][2]));
    volume += v;
  }
  return sum / (volume * -column.piola(0));
}

struct Top {
  double computed = nothing, exact = nothing;
};

/// Mean settlement of the highest layer of points.
Top top_of(const Outcome& o, const Column& column) {
  if (!o.ok()) return {nothing, column.settlement(column.height)};
  double highest = 0, sum = 0;
  int count = 0;
  for (const auto& x : o.first().position) highest = std::max(highest, x[2]);
  for (std::size_t p = 0; p < o.first().size(); ++p) {
    if (o.first().position[p][2] < highest - 1e-6 * column.height) continue;
    sum += o.first().position[p][2] - o.last().position[p][2];
    ++count;
  }
  return {sum / count, column.settlement(highest)};
}

Series stresses(const std::string& name, const Outcome& o, const Column& column, int colour) {
  Series s = marks_of(name, colour, 5);
  const auto piola = o.ok() ? piola_of(o, column) : std::vector<double>{};
  for (std::size_t p = 0; p < piola.size(); ++p) s.add(piola[p] * -1e-3, o.first().position[p][2]);
  return s;
}

Chart stress_chart(const Column& column, const std::string& title) {
  Chart chart = plain_chart(title, "vertical stress, compression [kPa]", "height above the foot at the start [m]");
  chart.series.push_back({"exact", {-1e-3 * column.piola(0), 0}, {0, column.height}, 0});
  return chart;
}

// A1 ---------------------------------------------------------------------------------------------------------------

constexpr Column self_weight{Law::corotated, 1e6, 200, 50};

/// The paper's dynamic set-up: linear functions, local damping 0.05, 4 s. The body force grows over the first 2 s, ten
/// periods: grown "in 20 time steps" of 1e-4 s it is a blow, of which this damping leaves a tenth after 4 s.
Overrides paper_dynamics(const char* integrator, double step) {
  return {{"solve.integrator", words(integrator)},
          {"solve.shape", words("linear")},
          {"solve.transfer", words("flip")},
          {"solve.stress_update", words("musl")},
          {"solve.implicit.step_s", step},
          {"solve.largest_step_s", step},
          {"solve.cfl", 0.8},
          {"solve.damping", 0.05},
          {"solve.gravity_ramp_s", 2.0},
          {"solve.end_time_s", 4.0},
          {"solve.frame_interval_s", 4.0},
          {"solve.history_interval_s", 0.05}};
}

void add_top(Bench& bench, const Outcome& o, double tolerance) {
  const Top top = top_of(o, self_weight);
  bench.compare(o, "top displacement", top.computed, top.exact, tolerance);
}

/// Twenty load steps with every linear solver, and how far these are from one another.
void add_statics(Bench& bench, Chart& profile, const char* shape, double top_tolerance, double stress_tolerance,
                 int colour) {
  std::vector<Outcome> runs;
  for (const LinearScheme& scheme : linear_schemes()) {
    runs.push_back(bench.run(fmt::format("quasi-static, {}, {}", shape, scheme.name),
                             Overrides{{"solve.shape", words(shape)}} + scheme.overrides));
    add_top(bench, runs.back(), top_tolerance);
    bench.measure(runs.back(), "stress profile", stress_error(runs.back(), self_weight), stress_tolerance);
    if (runs.size() == 1) continue;
    const double difference = top_of(runs.back(), self_weight).computed / top_of(runs[0], self_weight).computed - 1;
    bench.measure(runs.back(), "top displacement against " + linear_schemes()[0].name, difference, 1e-8);
  }
  profile.series.push_back(stresses(fmt::format("quasi-static, 20 steps, {}", shape), runs[0], self_weight, colour));
}

/// The paper's Table 1 in one run, and its Fig. 6b.
void paper_table(Bench& bench, Chart& profile) {
  Chart steps =
      log_chart("A1: error of the top displacement over the step (paper's scheme, t = 4 s)", "step [s]", "error");
  const auto study = [&](const std::string& name, const char* integrator, const Overrides& more,
                         const std::vector<std::pair<double, double>>& steps_and_tolerances, int colour) {
    Series s = marked_line(name, colour);
    for (const auto& [step, tolerance] : steps_and_tolerances) {
      const Outcome o = bench.run(fmt::format("{}, step {:g} s", name, step), paper_dynamics(integrator, step) + more);
      add_top(bench, o, tolerance);
      const Top top = top_of(o, self_weight);
      s.add(step, std::abs(top.computed / top.exact - 1));
      if (step == 1e-4) profile.series.push_back(stresses(name + ", step 1e-4 s", o, self_weight, colour));
    }
    steps.series.push_back(s);
  };
  // The tolerances are the paper's own errors; of explicit steps, with 22.7 % at 1e-4 s and none at 1e-5 s, the least.
  for (const LinearScheme& scheme : linear_schemes()) {
    study("reference, " + scheme.name, "newmark", scheme.overrides + Overrides{{"solve.preset", words("reference")}},
          {{1e-4, scheme.name == "pcg" ? 0.018 : 0.014}, {1e-3, 0.018}}, scheme.name == "pcg" ? 1 : 3);
  }
  study("explicit", "explicit", {{"solve.transfer_time_s", 1e30}}, {{1e-4, 0.012}, {1e-5, 0.012}, {2e-6, 0.012}}, 2);
  bench.picture("A1-step-size", png_of(steps));
}

// A1b --------------------------------------------------------------------------------------------------------------

Overrides refined_column(int level, const char* shape, int per_cell) {
  const double h = 50 / std::pow(2, level);
  return grid_of(h, per_cell) + Overrides{{"preprocess.box[0].extent_m[2]", h},
                                          {"preprocess.box[0].extent_m[3]", h},
                                          {"solve.shape", words(shape)},
                                          {"solve.wall[1].position_m", h},
                                          {"solve.wall[3].position_m", h}};
}

constexpr Column soft_column{Law::hencky, 1e4, 800, 50};

/// Functions and points whose stress error is followed over cell size.
struct Refinement {
  const char* shape;
  int per_cell;  // along each side
  bool always;   // else with the long runs only
};

constexpr Refinement refinements[] = {{"gimp", 2, true},       {"gimp", 3, false},      {"quadratic", 2, true},
                                      {"quadratic", 3, false}, {"quadratic", 4, false}, {"linear", 2, true}};

/// One refinement: its order, and its line in both charts.
void order_study(Bench& bench, const Refinement& study, Chart& chart, Chart& profile, int colour) {
  const std::string name =
      fmt::format("{}, {} points per cell", study.shape, study.per_cell * study.per_cell * study.per_cell);
  const int finest = bench.complete() ? 7 : 5;
  Series error{name, {}, {}, colour};
  Outcome o;
  for (int level = 2; level <= finest; ++level) {
    o = bench.run(fmt::format("{}, h = 50 / {}", name, 1 << level), refined_column(level, study.shape, study.per_cell));
    error.add(50 / std::pow(2, level), stress_error(o, soft_column));
    if (level == 5 && study.always) profile.series.push_back(stresses(study.shape, o, soft_column, colour));
  }
  // Errors of splines at points go flat; hats stall when points cross cells: both are shown, and promise no order.
  o.variant = name;
  const std::string range = fmt::format("order of the stress error, h = 12.5 to {:.1f} m", error.x.back());
  const double order = observed_order(error.x.data(), error.y.data(), static_cast<int>(error.x.size()));
  if (std::string(study.shape) == "gimp") {
    bench.at_least(o, range, order, 1);
    if (study.per_cell == 2) chart.series.push_back(slope_line(1, error));
  } else {
    bench.note(o, range, order);
  }
  bench.note(o, fmt::format("stress error, h = {:.1f} m", error.x.back()), error.y.back());
  chart.series.push_back(convergence(error));
}

/// Error over the load steps, h = 50 m / 2^4: the stress against the closed form, which the grid bounds from below, and
/// how far the top is from where twice as many steps as the most shown leave it.
void load_step_study(Bench& bench, const Column& column) {
  Chart chart = log_chart("A1b: error over load steps, h = 50 m / 2⁴, 8 points per cell",
                          "share of the weight in a step", "error");
  chart.y = Limits{1e-6, 0.5};  // room for the legend
  const int most = bench.complete() ? 160 : 40;
  int colour = 1;
  for (const char* shape : {"gimp", "quadratic", "linear"}) {
    Series top{fmt::format("{}, top against {} steps", shape, 2 * most), {}, {}, colour};
    Series stress{fmt::format("{}, stress against the closed form", shape), {}, {}, colour++};
    stress.dashed = stress.marks = true;
    double finest = nothing;
    for (int count = 2 * most; count >= 20; count /= 2) {
      const Outcome o = bench.run(fmt::format("{}, {} load steps", shape, count),
                                  refined_column(4, shape, 2) + Overrides{{"solve.implicit.step_s", 1.0 / count}});
      const double settled = top_of(o, column).computed;
      bench.note(o, "stress error", stress_error(o, column));
      if (count > most) {
        finest = settled;
        continue;
      }
      stress.add(1.0 / count, stress_error(o, column));
      top.add(1.0 / count, std::abs(settled / finest - 1));
      bench.note(o, fmt::format("top displacement against {} load steps", 2 * most), top.y.back());
    }
    chart.series.push_back(convergence(top));
    chart.series.push_back(stress);
  }
  bench.picture("A1b-steps", png_of(chart));
}

}  // namespace

void self_weight_column(Bench& bench) {
  Chart profile = stress_chart(self_weight, "A1: stress in a column under its own weight, 1 m grid, 400 points");
  // validation.md A1 for the solver's own functions. Of the paper's, the tolerance is its best error; there a cell has
  // one stress, so that points are off by a quarter of its weight.
  add_statics(bench, profile, "quadratic", 0.002, 0.002, 1);
  add_statics(bench, profile, "linear", 0.012, 0.006, 3);
  if (bench.complete()) paper_table(bench, profile);
  bench.picture("A1-stress", png_of(profile, 1400, 1100));
}

void large_compaction(Bench& bench) {
  Chart chart = log_chart("A1b: stress error over cell size, 40 load steps", "cell size [m]",
                          "error, mean of |P − P exact| over stress at the foot"),
        profile = stress_chart(soft_column, "A1b: stress in a column compacted to a third (h = 50 m / 2⁵)");
  int colour = 1;
  for (const Refinement& study : refinements)
    if (study.always || bench.complete()) order_study(bench, study, chart, profile, colour++);
  bench.picture("A1b-convergence", png_of(chart));
  bench.picture("A1b-stress", png_of(profile, 1400, 1100));
  load_step_study(bench, soft_column);
}

}  // namespace talus::validation
