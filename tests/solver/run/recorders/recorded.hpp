// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The history of a small scene, for tests of recorders.
#pragma once

#include "solver/run/recorders/history.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

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
    history.record({.time = row * interval,
                    .clock = solver->clock(),
                    .energies = solver->energies(),
                    .step_over_cfl = 0,
                    .counted = counted,
                    .solver = *solver});
    look(*solver, scene, history);
  }
  return history.rows();
}

inline RunHistory recorded(const Domain& d, const SolveOptions& o, On on, double end, double interval) {
  return recorded(d, o, on, end, interval, [](const Solver&, const Scene&, const History&) {});
}

}  // namespace talus::solver::testing
