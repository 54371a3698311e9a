// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gravity, the velocity at the start, and forces on parts of the mass.
#pragma once

#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

/// The keys of [solve] for gravity and the velocity at the start.
struct GravityOptions {
  std::vector<double> gravity = {0, 0, -9.81};       ///< [m/s2]
  std::vector<double> initial_velocity = {0, 0, 0};  ///< [m/s]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

/// The keys of [[solve.load]]: a force on the points that start inside a box.
struct LoadOptions {
  std::vector<double> box = {0, 0, 0, 0, 0, 0};  ///< west, east, south, north [m], bottom, top above the ground [m]
  std::vector<double> force = {0, 0, 0};         ///< in all [N]
  double ramp = 0;                               ///< time over which it grows [s]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
