// The lowest stiffness that leaves a flow unchanged ([solve.material] stiffness = "auto"; docs/decisions/0008).
#pragma once

#include <string>

#include "common/domain/domain.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The demand of a scene on the stiffness.
struct StiffnessDemand {
  double speed = 0;          ///< that the energy line allows somewhere in the domain [m/s]
  double modulus = 0;        ///< Young's modulus chosen [Pa]
  double transfer_time = 0;  ///< that goes with it: the same time in seconds [CFL steps]
  std::string reason;
};

/// The modulus that keeps the dynamic pressure at the highest speed to a strain of 2 %, and with it the weight of what
/// is released to 1 %, and the decay of velocity finer than the grid above a step; never more than the recipe's own.
/// Pressures are over the modulus of confined compression.
StiffnessDemand lowest_stiffness(const Domain& domain, const SolveOptions& options);

/// The options with `stiffness = "auto"` carried out.
SolveOptions with_stiffness(SolveOptions options, const StiffnessDemand& demand);

}  // namespace talus::solver
