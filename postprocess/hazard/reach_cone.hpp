// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The cone of the angle of reach: a second opinion that asks for no run in time.
#pragma once

#include <string>
#include <vector>

#include "common/run/map_fields.hpp"
#include "postprocess/options/hazard.hpp"

namespace talus::postprocess {

/// What a mass reaches that falls by an angle of reach (Fahrboeschung; Heim 1932) from every cell of its release.
struct ReachCone {
  std::string name;    ///< "Corominas 1996"; "angle_deg" for the recipe's own
  double tangent = 0;  ///< H/L [-]
  /// Height of the energy line above the ground where it passes, from the release on over cells that it passes: NaN
  /// elsewhere. sqrt(2 g head) bounds the speed there (Körner 1980). [rows * columns] [m]
  std::vector<double> head;
  double area = 0;     ///< in plan, of the cells reached [m2]
  double covered = 0;  ///< share of the run's footprint that lies within [-]; NaN where there is no footprint
};

/// 1 in the cells that a cone reaches, else 0, so that an outline passes between those and the others.
std::vector<double> reached_cells(const ReachCone& cone);

/// The cones that the recipe asks for: its own angle first, then those usual for the released volume (the regressions
/// of common/map/usual_reach.hpp that hold for it), flatter ones last. `footprint`: peak thickness from which the run's
/// footprint counts [m]. Empty where nothing was released.
std::vector<ReachCone> reach_cones(const RunMaps& maps, double volume, double footprint,
                                   const ReachConeOptions& options);

}  // namespace talus::postprocess
