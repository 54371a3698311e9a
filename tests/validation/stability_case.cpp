// C1: the sand column of A3 in steps of 1 to 30 times the CFL step, against explicit steps on the same grid.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"

namespace talus::validation {
namespace {

constexpr double cfl_step = 4.27e-4;  // 0.0225 m over the wave speed and the square root of three [s]

/// Mean distance of the points from the wall at the end [m].
double centre_of(const Outcome& o) {
  if (!o.ok()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const auto& p : o.last().position) sum += p[0];
  return sum / static_cast<double>(o.last().size());
}

double run_out_of(const Outcome& o) {
  return o.ok() ? front_of(o.last(), 0.0225, 0.0075) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void large_steps(Bench& bench) {
  const Outcome reference = bench.run("explicit, 0.1 CFL", {{"solve.integrator", words("explicit")}, {"solve.cfl", 0.1}});
  const double expected = centre_of(reference), reach = run_out_of(reference);
  Chart chart;
  chart.title = "C1: sand column, centre of mass over the step";
  chart.x_label = "step over the CFL step";
  chart.y_label = "difference to explicit steps of 0.1 CFL [%]";
  chart.log_x = true;
  int colour = 1;
  struct Scheme {
    const char* tangent;
    const char* linear_solver;
  };
  for (const Scheme& scheme : {Scheme{"frozen-yield", "pcg"}, {"exact", "bicgstab"}}) {
    Series s{fmt::format("newmark, {} tangent", scheme.tangent), {}, {}, colour++};
    s.marks = true;
    for (const double over_cfl : {1.0, 3.0, 10.0, 30.0}) {
      if (over_cfl != 10 && !bench.complete()) continue;
      const Outcome o = bench.run(fmt::format("{}, {:g} CFL", scheme.tangent, over_cfl),
                                  {{"solve.implicit.step_s", over_cfl * cfl_step},
                                   {"solve.implicit.tangent", words(scheme.tangent)},
                                   {"solve.implicit.linear_solver", words(scheme.linear_solver)}});
      const double centre = centre_of(o), cuts = o.last_of("step_cuts");
      // 30 CFL need only finish (validation.md C1).
      const double tolerance = over_cfl > 20 ? 0.1 : 0.03;
      bench.compare(o, "run-out", run_out_of(o), reach, tolerance);
      bench.compare(o, "centre of mass", centre, expected, tolerance);
      bench.measure(o, "steps cut, share", o.ok() ? cuts / static_cast<double>(o.run.summary.steps) : 0, over_cfl > 20 ? 0.1 : 0.01);
      s.x.push_back(over_cfl);
      s.y.push_back(100 * (centre / expected - 1));
    }
    chart.series.push_back(s);
  }
  Series few{"explicit", {0.1}, {0}, 0};
  few.marks = true;
  for (const double cfl : {0.25, 0.5}) {
    const Outcome o = bench.run(fmt::format("explicit, {:g} CFL", cfl), {{"solve.integrator", words("explicit")}, {"solve.cfl", cfl}});
    bench.compare(o, "run-out", run_out_of(o), reach, 0.02);
    bench.compare(o, "centre of mass", centre_of(o), expected, 0.02);
    few.x.push_back(cfl);
    few.y.push_back(100 * (centre_of(o) / expected - 1));
  }
  chart.series.push_back(few);
  bench.picture("C1-centre", png_of(chart));
}

}  // namespace talus::validation
