// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/boundary/plane_walls.hpp"

namespace talus::solver {

template <class Real>
Walls<Real> walls_at(const std::vector<PlaneWall>& walls, double time, const WallFrame& frame) {
  Walls<Real> standing;
  for (const PlaneWall& w : walls) {
    const double now = time * (1 + 1e-12);  // events a rounding apart are one
    if (now >= w.to) continue;
    Wall<Real>& wall = standing.list[standing.count++];
    wall.axis = w.axis;
    wall.side = w.side;
    const double position = w.position + w.speed * time;
    wall.position = static_cast<Real>((position - frame.origin[w.axis]) / frame.cell[w.axis]);
    wall.kind = w.kind;
    wall.friction = static_cast<Real>(w.friction);
    wall.speed = static_cast<Real>(w.speed);
  }
  return standing;
}

template Walls<float> walls_at(const std::vector<PlaneWall>&, double, const WallFrame&);
template Walls<double> walls_at(const std::vector<PlaneWall>&, double, const WallFrame&);

}  // namespace talus::solver
