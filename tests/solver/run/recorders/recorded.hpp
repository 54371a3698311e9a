// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The history of a small scene, for tests of recorders.
#pragma once

#include "solver/run/recorders/history.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

constexpr double block_slope = 30 * std::numbers::pi / 180, block_volume = 8 * 8 * 2;  // [rad], [m3]

/// A block of 8 x 8 x 2 m on a slope towards the east, from 10 to 18 m.
inline Domain block_on_a_slope(int columns) {
  return filled(ground(columns, 24, 1.0, 1.0, [](double x, double) { return 100 - std::tan(block_slope) * x; }),
                {10, 18, 8, 16, 0, 2});
}

/// Stiff, on a bed without friction.
inline SolveOptions block_without_friction(double youngs_modulus, Integrator integrator = Integrator::explicit_) {
  SolveOptions o = elastic_options(youngs_modulus, integrator);
  o.base.law = FrictionLaw::none;
  return o;
}

/// Records what a solver is at.
inline void record(History& history, double time, Solver& solver, const RunMemory& counted, double step_over_cfl = 0) {
  history.record({.time = time,
                  .clock = solver.clock(),
                  .energies = solver.energies(),
                  .step_over_cfl = step_over_cfl,
                  .counted = counted,
                  .solver = solver});
}

/// The history of a run to `end`, a record every `interval` [s]; `look` is called after each record.
template <class Look>
RunHistory recorded(const Domain& d, const SolveOptions& o, On on, double end, double interval, Look&& look) {
  const Scene scene = make_scene(d, o);
  History history(o, scene);
  const auto solver = make_solver(scene, o, on);
  RunMemory counted;
  for (int row = 0; row * interval < end + 0.5 * interval; ++row) {
    const auto count = [&](const BatchReport& batch) { counted.outflow_volume += batch.outflow_volume; };
    if (row > 0) run_to(*solver, row * interval, count);
    record(history, row * interval, *solver, counted);
    look(*solver, scene, history);
  }
  return history.rows();
}

inline RunHistory recorded(const Domain& d, const SolveOptions& o, On on, double end, double interval) {
  return recorded(d, o, on, end, interval, [](const Solver&, const Scene&, const History&) {});
}

}  // namespace talus::solver::testing
