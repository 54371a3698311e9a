// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a search for the factor of safety leaves behind: maps of the mass that fails, facts, stability.json.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run_file.hpp"
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

/// The lines for the log: factor, bracket, mass.
std::vector<std::string> stability_lines(const Stability& found, const CriticalMass& mass);
/// Warns of what does not hold as it stands: no bracket, no motion, a mass that is no part of the ground.
void warn_of_stability(const Stability& found, const CriticalMass& mass);
/// The outcome as name and value, for run.h5 and *.used.toml.
std::vector<std::pair<std::string, std::string>> stability_facts(const Stability& found, const CriticalMass& mass);
/// The text of stability.json: factor with bracket, trials, mass; lengths in m, volumes in m3.
std::string stability_json(const std::string& scene, const Stability& found, const CriticalMass& mass);

/// This function writes run.h5: the ground at rest as a run of no steps, with the maps of the mass that fails.
void write_stability_run(const std::filesystem::path& file, const Domain& domain, const StabilitySearch& search,
                         const CriticalMass& mass, RunSummary summary, const AnyDevice& device);

}  // namespace talus::solver
