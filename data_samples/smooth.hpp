// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Curves that terrains bend along.
#pragma once

#include <algorithm>

namespace talus::samples {

/// From 0 (t <= 0) to 1 (t >= 1) without a kink.
inline double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Integral of smooth() from 0 to t.
inline double smooth_integral(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * c - c * c * c * c / 2 + std::max(0.0, t - 1);
}

}  // namespace talus::samples
