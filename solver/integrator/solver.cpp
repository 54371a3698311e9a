// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/solver.hpp"

#include <fmt/format.h>

namespace talus::solver {

void refuse_step(const Clock& clock, double step, const StepStats& stats, bool dynamic) {
  if (!dynamic && stats.indefinite) {
    throw NumericalError({fmt::format("step {}, t = {:.6g} s: the equations of equilibrium are singular or unstable",
                                      clock.step + 1, clock.time),
                          "a body without support, or one that must fall, has no equilibrium",
                          "Hold it with walls or a base law, or use integrator = \"newmark\""});
  }
  throw NumericalError(
      {fmt::format("step {}, t = {:.6g} s: no convergence even with a step of {:.3g} s (unbalanced force {:.2g} of "
                   "the forces, {} Newton and {} linear iterations)",
                   clock.step + 1, clock.time, step, stats.residual, stats.newton, stats.linear),
       dynamic ? "the step is too long, or the mass tears apart" : "there may be no equilibrium to find",
       dynamic ? "Lower [solve.implicit] step_s"
               : "Hold the body with walls, ramp the load more slowly, or use integrator = \"newmark\""});
}

ParticleState at_home(const SolverState& state, int columns) {
  ParticleState points = state.points;
  const int across = blocks_across(columns);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto key = static_cast<std::uint64_t>(state.homes[p]);
    const HomeCell home(across, key);
    const int cell[3] = {home.i, home.j, home.k};
    for (std::size_t a = 0; a < 3; ++a) {
      points.cell[a][p] = cell[a];
      points.offset[a][p] = (key >> a & 1) != 0 ? 0.25 : -0.25;  // the halves of a cell that home_key() tells apart
    }
  }
  for (auto& side : points.sides) side.clear();  // none is split that was not then
  return points;
}

}  // namespace talus::solver
