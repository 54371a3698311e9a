// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve for a factor of safety: domain.vdb -> run.h5 and stability.json, with maps of the mass that fails.
#pragma once

#include <vector>

#include "common/domain/domain.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/stability/stability.hpp"

namespace talus::solver {

/// The mass that fails first: the points whose way is at least half of the mean one (T40b).
struct CriticalMass {
  std::vector<double> thickness;     ///< vertical, over every map cell [m]
  std::vector<double> displacement;  ///< mean over a column's points, over the way of the mass [-]
  double volume = 0;                 ///< [m3]
  double area = 0;                   ///< of the columns that it stands in [m2]
  double depth = 0;                  ///< from its highest to its lowest point in a column, at most [m]
  double share = 0;                  ///< of the volume of the ground [-]
};

/// The mass that fails, of a failure whose points were followed.
CriticalMass critical_mass(const Scene& scene, const SolveOptions& options, const Failure& failure);

/// Warns of what does not hold as it stands: no bracket, no motion, a mass that is no part of the ground.
void warn_of_stability(const Stability& found, const CriticalMass& mass);

/// This function finds the factor of safety in place of a run in time (T40), and writes run.h5 and stability.json.
/// It adds to the context's results and returns the facts for the used recipe, none with --check.
Facts find_stability(StageContext& context, const SolveOptions& options, const AnyDevice& device, const Domain& domain);

}  // namespace talus::solver
