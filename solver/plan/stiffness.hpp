// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lowest stiffness that leaves a flow unchanged ([solve.material] stiffness = "auto"; docs/notes/integrators.md).
#pragma once

#include <string>
#include <vector>

#include "solver/options/solve.hpp"
#include "solver/plan/energy_line.hpp"

namespace talus::solver {

/// The demand of a scene on the stiffness.
struct StiffnessDemand {
  double modulus = 0;  ///< Young's modulus chosen [Pa]
  std::string reason;
};

/// The modulus that keeps the dynamic pressure at the highest speed to a strain of `stiffness_strain`, and the weight
/// below the highest point of what is released to half of that, or to half of the recipe's `accuracy` where that is
/// less: what weight strains is missing in the thickness of the deposit. Never more than the recipe's own. Pressures
/// are over the modulus of confined compression.
StiffnessDemand lowest_stiffness(const SolveOptions& options, const SpeedBound& bound);

/// The strain by which `stiffness = "auto"` goes at an accuracy: sqrt(strain) grows with the share of the deposit that
/// lies elsewhere (docs/notes/integrators.md).
double strain_for(double accuracy);

/// The options with `stiffness = "auto"` carried out.
SolveOptions with_stiffness(SolveOptions options, const StiffnessDemand& demand);

/// Whether a recipe leaves the stiffness to the program, by its own word or by `accuracy`.
bool leaves_stiffness(const SolveOptions& options);

/// The options with `stiffness = "auto"` carried out, and what `accuracy` says of it. A line on the modulus is added to
/// `reasons`.
SolveOptions settle_stiffness(SolveOptions options, const SpeedBound& bound, std::vector<std::string>& reasons);

}  // namespace talus::solver
