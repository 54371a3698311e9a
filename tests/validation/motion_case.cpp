// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B6: an elastic bar in vibration, free fall, the patch test.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"

namespace talus::validation {
namespace {

/// Mean period from the zeros of the momentum, which come twice a period.
double period_of(const std::vector<double>& time, const std::vector<double>& momentum) {
  double last = nothing;
  int zeros = 0;
  for (std::size_t i = 2; i < time.size(); ++i) {  // the first record is at rest
    if (momentum[i - 1] * momentum[i] > 0) continue;
    last = time[i - 1] + (time[i] - time[i - 1]) * momentum[i - 1] / (momentum[i - 1] - momentum[i]);
    ++zeros;
  }
  return 2 * last / zeros;
}

std::vector<double> energy_drift(const Outcome& o) {
  const auto kinetic = o.history("kinetic_J"), elastic = o.history("elastic_J"), potential = o.history("potential_J");
  double peak = 0;
  for (const double k : kinetic) peak = std::max(peak, k);
  std::vector<double> drift;
  for (std::size_t i = 0; i < kinetic.size(); ++i)
    drift.push_back((kinetic[i] + elastic[i] + potential[i] - kinetic[0] - elastic[0] - potential[0]) / peak);
  return drift;
}

void vibrating_bar(Bench& bench) {
  Chart chart =
      plain_chart("B6: energy of a vibrating bar, drift over the peak of the kinetic energy", "time [s]", "drift");
  int colour = 1;
  for (const char* integrator : {"newmark", "explicit"}) {
    const Outcome o = bench.run(fmt::format("bar, {}", integrator), {{"solve.integrator", words(integrator)}});
    const auto time = o.history("time_s"), momentum = o.history("momentum_z_kg_m_s");
    const double exact = 4 * 10 / std::sqrt(1e8 / 1000);
    bench.compare(o, "period", o.ok() ? period_of(time, momentum) : nothing, exact, 0.01);
    const auto drift = o.ok() ? energy_drift(o) : std::vector<double>{nothing};
    bench.measure(o, "energy drift in three periods", drift.back(), 0.05);
    if (o.ok()) chart.series.push_back({integrator, time, drift, colour});
    ++colour;
  }
  bench.picture("B6-energy", png_of(chart));
}

void free_fall(Bench& bench) {
  const double v[3] = {3, -2, 5}, g = -9.81, time = 1;
  for (const char* integrator : {"newmark", "explicit"}) {
    const Outcome o = bench.run(fmt::format("free fall, {}", integrator),
                                {{"solve.integrator", words(integrator)},
                                 {"preprocess.laboratory.cells[0]", whole(24)},
                                 {"preprocess.laboratory.cells[1]", whole(24)},
                                 {"preprocess.laboratory.corner_m[1]", -6.25},
                                 {"preprocess.box[0].extent_m[4]", 10.0},
                                 {"preprocess.box[0].extent_m[5]", 12.0},
                                 {"solve.transfer", words("apic")},
                                 {"solve.shape", words("quadratic")},
                                 {"solve.gravity_m_s2", std::vector<double>{0, 0, g}},
                                 {"solve.initial_velocity_m_s", std::vector<double>{v[0], v[1], v[2]}},
                                 {"solve.implicit.step_s", 0.01},
                                 {"solve.implicit.newton_tolerance", 1e-12},  // exact up to what the solve leaves
                                 {"solve.implicit.linear_tolerance", 1e-12},
                                 {"solve.end_time_s", time},
                                 {"solve.frame_interval_s", time},
                                 {"solve.history_interval_s", 0.1}});
    const double mass = 2000;
    double worst = nothing, way = nothing;
    if (o.ok()) {
      worst = way = 0;
      const char* const names[] = {"momentum_x_kg_m_s", "momentum_y_kg_m_s", "momentum_z_kg_m_s"};
      for (int a = 0; a < 3; ++a) {
        const double exact = v[a] + (a == 2 ? g * time : 0);
        worst = std::max(worst, std::abs(o.last_of(names[a]) / (mass * exact) - 1));
      }
      for (std::size_t p = 0; p < o.first().size(); ++p) {
        for (std::size_t a = 0; a < 3; ++a) {
          const double exact = v[a] * time + (a == 2 ? 0.5 * g * time * time : 0);
          way = std::max(way, std::abs(o.last().position[p][a] - o.first().position[p][a] - exact));
        }
      }
    }
    // The trapezoid is exact but for what the linear solver leaves; an explicit step keeps momentum to rounding, and
    // moves with the velocity of its end, so it is half a step ahead.
    const bool exact = std::string(integrator) == "newmark";
    bench.measure(o, "momentum of the fall", worst, 1e-9);
    const double steps = o.ok() ? static_cast<double>(o.run.summary.steps) : 1;
    bench.measure(o, "way of the fall [m]", way, exact ? 1e-6 : 0.5 * 9.81 * time * time / steps * 1.01);
  }
}

/// A block between rollers, one of which moves by 1 % in a single step: the strain is the same everywhere, whatever the
/// lattice of the points, as long as their gradients integrate exactly: full cells of linear functions. (One point per
/// cell leaves hourglass motions free, and quadratic functions held at nodes cannot follow a uniform strain: those
/// layouts the functions do not allow.)
void patch_test(Bench& bench) {
  for (const long points : {2L, 3L, 4L}) {
    Overrides overrides{{"preprocess.grid.points_per_cell", std::vector<std::int64_t>(3, points)},
                        {"preprocess.box[0].extent_m[2]", 2.0},
                        {"preprocess.box[0].extent_m[5]", 2.0},
                        {"preprocess.laboratory.cells[0]", whole(14)},
                        {"solve.integrator", words("quasi-static")},
                        {"solve.shape", words("linear")},
                        {"solve.gravity_m_s2", std::vector<double>{0, 0, 0}},
                        {"solve.material.poisson_ratio", 0.25},
                        {"solve.base.law", words("none")},
                        {"solve.implicit.step_s", 1.0},
                        {"solve.implicit.newton_tolerance", 1e-12},
                        {"solve.implicit.linear_tolerance", 1e-12},
                        {"solve.end_time_s", 1.0},
                        {"solve.frame_interval_s", 1.0},
                        {"solve.history_interval_s", 1.0}};
    int walls = 0;
    const auto wall = [&](const char* axis, double position, const char* side, double speed) {
      const std::string key = fmt::format("solve.wall[{}].", walls++);
      overrides = overrides + Overrides{{key + "axis", words(axis)},
                                        {key + "position_m", position},
                                        {key + "material_is", words(side)},
                                        {key + "kind", words("roller")},
                                        {key + "speed_m_s", speed}};
    };
    wall("x", 0, "above", 0);
    wall("x", 2, "below", -0.02);
    wall("y", 0, "above", 0);
    wall("y", 1, "below", 0);
    wall("z", 2, "below", 0);
    const Outcome o = bench.run(fmt::format("patch, {} per cell", points * points * points), overrides);
    const double stiffness = 1e8 * 0.75 / (1.25 * 0.5), strain = std::log(0.99),
                 volume = 2 * 1 * 2;  // E (1-nu) / ((1+nu)(1-2nu))
    bench.compare(o, "elastic energy of uniform strain", o.last_of("elastic_J"),
                  0.5 * stiffness * strain * strain * volume, 1e-9);
    double worst = o.ok() ? 0 : nothing;
    const double pressure = -1e8 / (3 * 0.5) * strain;
    if (o.ok()) {
      for (const float p : o.last().pressure) worst = std::max(worst, std::abs(static_cast<double>(p) / pressure - 1));
    }
    bench.measure(o, "pressure of uniform strain", worst, 1e-6);  // the file keeps single precision
  }
}

}  // namespace

void elastic_motion(Bench& bench) {
  vibrating_bar(bench);
  free_fall(bench);
  patch_test(bench);
}

}  // namespace talus::validation
