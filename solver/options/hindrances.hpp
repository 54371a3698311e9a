// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe holds that a way of stepping cannot do, and why.
#pragma once

#include <string>

namespace talus::solver {

struct SolveOptions;

/// What of a recipe is in the way of an integrator.
struct Hindrance {
  std::string key;     ///< as the recipe has it; empty: nothing is in the way
  std::string reason;  ///< in words
  /// Whether something is in the way.
  explicit operator bool() const { return !key.empty(); }
};

/// What is in the way of inertia implicit along columns.
Hindrance beyond_columns(const SolveOptions& options);

/// The longest column-implicit step that the materials bear, over the CFL step (T6d): 1 where one holds tension, for
/// what a corner of it swings with is not in the springs along columns.
double longest_by_columns(const SolveOptions& options);

/// The first law of a material that Newton's iterations do not step.
Hindrance law_beyond_newton(const SolveOptions& options);

/// What keeps integrator = "auto" from Newmark's steps where all is at rest.
Hindrance beyond_rest(const SolveOptions& options);

}  // namespace talus::solver
