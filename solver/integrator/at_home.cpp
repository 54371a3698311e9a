// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/at_home.hpp"

#include "solver/state/grid_view.hpp"

namespace talus::solver {

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
  return points;
}

}  // namespace talus::solver
