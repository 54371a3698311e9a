// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// C1: the sand column of A3 in steps by columns and in Newmark's of 1 to 30 CFL steps, against explicit steps.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/sand.hpp"

namespace talus::validation {
namespace {

/// Mean distance of the points from the wall at the end [m].
double centre_of(const Outcome& o) { return o.ok() ? centre_of(o.last())[0] : nothing; }
double reach_of(const Outcome& o) { return o.ok() ? reach_of(o.last()) : nothing; }
double end_of(const Outcome& o, const Sand& s) { return o.ok() ? front_of(o.last(), s) : nothing; }

/// Runs on one grid, judged by explicit steps of a tenth of a CFL step; coarse: of a quarter, and the reach by 8 %.
class ShortSteps {
 public:
  ShortSteps(Bench& bench, const Sand& sand)
      : bench_(bench),
        sand_(sand),
        reference_(run_at("explicit", shortest())),
        centre_(centre_of(reference_)),
        reach_(reach_of(reference_)) {
    bench_.note(reference_, "run-out [m]", end_of(reference_, sand_));
  }

  double shortest() const { return bench_.coarse() ? 0.25 : 0.1; }  ///< over the CFL step
  Bench& bench() const { return bench_; }
  const Sand& sand() const { return sand_; }
  std::string grid() const { return fmt::format(", h = {:g} m", sand_.h); }
  Outcome run(const std::string& name, const Overrides& more) const {
    return bench_.run(name + grid(), overrides_of(sand_) + more);
  }
  Outcome run_at(const char* integrator, double cfl) const {
    return run(fmt::format("{}, {:g} CFL", integrator, cfl),
               {{"solve.integrator", words(integrator)}, {"solve.cfl", cfl}});
  }
  /// Adds the rows; returns how far the centre of mass is off [%].
  double judge(const Outcome& o, double tolerance) const {
    bench_.compare(o, "reach of 99 %", reach_of(o), reach_, bench_.coarse() ? 0.08 : tolerance);
    bench_.compare(o, "centre of mass", centre_of(o), centre_, tolerance);
    bench_.note(o, "run-out [m]", end_of(o, sand_));
    return 100 * (centre_of(o) / centre_ - 1);
  }

 private:
  Bench& bench_;
  Sand sand_;
  Outcome reference_;
  double centre_, reach_;
};

/// Newmark steps of these lengths [CFL steps].
Series newmark_line(const ShortSteps& against, const std::vector<double>& lengths, int colour) {
  const double cfl_step = 4.27e-4 * against.sand().h / 0.0225;  // cell over wave speed and square root of three [s]
  Bench& bench = against.bench();
  Series line = marked_line("newmark", colour);
  for (const double over_cfl : lengths) {
    const Outcome o =
        against.run(fmt::format("newmark, {:g} CFL", over_cfl), {{"solve.implicit.step_s", over_cfl * cfl_step}});
    const double cuts = o.last_of("step_cuts"), steps = static_cast<double>(o.run.summary.steps);
    line.x.push_back(over_cfl);
    line.y.push_back(against.judge(o, over_cfl > 20 ? 0.1 : 0.03));  // 30 CFL need only finish (validation.md C1)
    bench.note(o, "Newton iterations a step", o.last_of("newton_iterations") / steps);
    if (over_cfl > 20) {
      bench.note(o, "steps cut, share", cuts / steps);
    } else {
      bench.measure(o, "steps cut, share", o.ok() ? cuts / steps : 0, 0.01);
    }
  }
  return line;
}

/// Steps of these shares of the CFL step, on a line that is called by its integrator.
Series cfl_line(const ShortSteps& against, Series line, const std::vector<double>& lengths, double tolerance) {
  line.marks = true;
  for (const double cfl : lengths) {
    line.add(cfl, against.judge(against.run_at(line.name.c_str(), cfl), tolerance));
  }
  return line;
}

/// All steps on one grid against the shortest; the lengths of implicit ones in CFL steps.
void compare_steps(Bench& bench, const Sand& s, const std::vector<double>& lengths) {
  const ShortSteps against(bench, s);
  Chart chart = plain_chart("C1: sand column, centre of mass over the step" + against.grid(), "step over the CFL step",
                            fmt::format("difference to explicit steps of {:g} CFL [%]", against.shortest()));
  chart.log_x = true;
  chart.series.push_back(newmark_line(against, lengths, 1));
  const bool coarse = bench.coarse();
  const std::vector<double> short_ones = coarse ? std::vector<double>{0.5} : std::vector<double>{0.25, 0.5},
                            by_columns = coarse ? std::vector<double>{1.5} : std::vector<double>{0.5, 1, 1.5};
  chart.series.push_back(cfl_line(against, {"explicit", {against.shortest()}, {0}, 0}, short_ones, 0.02));
  chart.series.push_back(cfl_line(against, {"column-implicit", {}, {}, 2}, by_columns, 0.03));
  bench.picture(fmt::format("C1-centre-{:g}", s.h), png_of(chart));
}

}  // namespace

void large_steps(Bench& bench) {
  Sand s;
  s.per_cell = 3;
  if (bench.coarse()) {
    s.h = 0.09 / 2;
    return compare_steps(bench, s, {10});
  }
  s.h = 0.09 / 4;
  compare_steps(bench, s, {10});
  if (!bench.complete()) return;
  s.h = 0.09 / 8;  // the walls stand on nodes: the nearest to A3's own 0.01 m
  compare_steps(bench, s, {1, 3, 10, 30});
}

}  // namespace talus::validation
