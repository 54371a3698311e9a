// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `accuracy`, integrator = "auto" and stiffness = "auto" settle before a run, from the scene alone
// (docs/notes/integrators.md).
#pragma once

#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/energy_line.hpp"

namespace talus::solver {

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

/// The same with what `accuracy` says of it. A line on the modulus is added to `reasons`.
SolveOptions settle_stiffness(SolveOptions options, const SpeedBound& bound, std::vector<std::string>& reasons);

/// The steps of a flow, and why they are taken.
struct StepChoice {
  Integrator flow = Integrator::explicit_;  ///< explicit or column-implicit
  double cfl = 0;                           ///< [-]
  bool rests = false;                       ///< Newmark's steps may follow where all is at rest
  std::vector<std::string> reasons;         ///< a sentence each
};

// From this share of the release on, columns one cell wide with nothing beside them count; longer column-implicit steps
// than these let them forget part of their stress (T6d).
inline constexpr double noticed_alone = 0.01, longest_unforgotten = 0.5;
/// The share of the release in such columns, where column-implicit steps can let them forget it; else 0 [-].
double released_alone(const Domain& domain, const SolveOptions& options);

/// The allowed steps that take the least work at the accuracy asked for; without one, each as long as the recipe says,
/// or as it takes by itself.
StepChoice choose_steps(const Domain& domain, const SolveOptions& options, const SpeedBound& bound);

/// Warns of an `accuracy` that no steps keep, on ground that is rough for the flow (docs/notes/integrators.md).
void warn_of_unkept_accuracy(const Domain& domain, const SolveOptions& options, const EnergyLine& line);

/// The options with the choice carried out.
SolveOptions with_steps(SolveOptions options, const StepChoice& choice);

/// The options with integrator = "auto" carried out. Lines on why steps are as they are are added to `reasons`.
SolveOptions settle_steps(const Domain& domain, SolveOptions options, const SpeedBound& bound,
                          std::vector<std::string>& reasons);

}  // namespace talus::solver
