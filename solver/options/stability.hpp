// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The factor of safety: what a search for it is told.
#pragma once

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct SolveOptions;

/// The keys of [solve.stability].
struct StabilityOptions {
  bool factor_of_safety = false;  ///< find it, instead of a run in time
  double tolerance = 0.005;       ///< width of the bracket over its lower end [-]
  double largest_factor = 20;     ///< factor beyond which the search ends [-]; no key
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
