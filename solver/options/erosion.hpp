// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the ground of [[preprocess.erodible]] is taken along.
#pragma once

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct SolveOptions;

/// What decides how deep ground is eroded: its strength, or a rate.
enum class ErosionLaw { strength, rate };

/// The keys of [solve.erosion].
struct ErosionOptions {
  ErosionLaw law = ErosionLaw::strength;
  double rate = 0;  ///< E of (T52) [1/m]

  bool by_rate() const { return law == ErosionLaw::rate; }
  /// Declares the keys with defaults, help and what they need of the rest of the recipe.
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
