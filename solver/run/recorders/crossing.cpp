// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/crossing.hpp"

#include <algorithm>
#include <cmath>

namespace talus::solver {

double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

int crossing(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& from,
             const std::array<double, 2>& to) {
  if (std::max(from[0], to[0]) < std::min(a[0], b[0]) || std::min(from[0], to[0]) > std::max(a[0], b[0]) ||
      std::max(from[1], to[1]) < std::min(a[1], b[1]) || std::min(from[1], to[1]) > std::max(a[1], b[1]))
    return 0;
  const bool was_left = turn(a, b, from) >= 0, is_left = turn(a, b, to) >= 0;
  if (was_left == is_left) return 0;
  if ((turn(from, to, a) >= 0) == (turn(from, to, b) >= 0)) return 0;  // passes beside the piece
  return was_left ? 1 : -1;
}

double distance(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& place) {
  const double x = b[0] - a[0], y = b[1] - a[1];
  const double along = ((place[0] - a[0]) * x + (place[1] - a[1]) * y) / (x * x + y * y);
  const double share = std::clamp(along, 0.0, 1.0);
  return std::hypot(place[0] - a[0] - share * x, place[1] - a[1] - share * y);
}

}  // namespace talus::solver
