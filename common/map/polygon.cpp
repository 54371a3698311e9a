// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

double signed_distance(const MapPolygon& polygon, double x, double y) {
  double nearest = 1e300;
  bool inside = false;
  for (const auto& ring : polygon.rings) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const auto &a = ring[n], &b = ring[(n + 1) % ring.size()];
      const double ex = b[0] - a[0], ey = b[1] - a[1], px = x - a[0], py = y - a[1];
      const double along = std::clamp((px * ex + py * ey) / std::max(ex * ex + ey * ey, 1e-300), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(px - along * ex, py - along * ey));
      if ((a[1] > y) != (b[1] > y) && px < ex * py / ey) inside = !inside;
    }
  }
  return inside ? -nearest : nearest;
}

}  // namespace talus
