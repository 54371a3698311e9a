// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The speed of the inside of a slab on a slope, away from its ends.
#pragma once

#include "solver/integrator/solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// The mean velocity down a slope [deg] that falls eastwards, of what is within 4 m of the centre [m/s].
inline double speed_inside(const Solver& solver, const Scene& scene, double slope) {
  const double angle = slope * std::numbers::pi / 180;
  const ParticleState s = solver.state().points;
  const auto x = positions(scene, s);
  const double middle = centre(solver, scene).x;
  double sum = 0, volume = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    if (std::abs(x[p][0] - middle) > 4) continue;
    sum += s.volume[p] * (s.velocity[0][p] * std::cos(angle) - s.velocity[2][p] * std::sin(angle));
    volume += s.volume[p];
  }
  return sum / volume;
}

}  // namespace talus::solver::testing
