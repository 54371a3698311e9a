// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of the shaking of the ground before a run.
#pragma once

#include <string>

#include "solver/integrator/shaking.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The final velocity of the ground, over its largest, from which an accelerogram is said not to end at rest [-]. What
/// is left of drift in corrected records is far smaller.
inline constexpr double most_final_velocity = 0.05;

/// One line on an accelerogram: its samples, its largest acceleration and velocity.
std::string shaking_words(const Shaking& shaking);

/// Warns of what is hardly meant of an accelerogram: a ground that does not come to rest, a run that ends before it
/// does.
void warn_of_shaking(const Shaking& shaking, const SolveOptions& options);

}  // namespace talus::solver
