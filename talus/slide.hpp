// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A slide as two elevation models show it, measured for a first recipe.
#pragma once

#include <filesystem>
#include <optional>

#include "common/map/raster.hpp"

namespace talus::command {

/// What went down and what rose between the two models.
struct Slide {
  double cell = 0;              ///< of the elevation models [m]
  double volume = 0;            ///< of the release [m3]
  double area = 0;              ///< of the release in plan [m2]
  double width = 0;             ///< of the release: four times its area over its outline [m]
  double median_thickness = 0;  ///< half of the volume stands in thicker columns [m]
  double crown = 0;             ///< elevation of the highest released cell [m]
  double drop = 0;              ///< from the crown to the deposit cell farthest from it [m]; 0: no deposit is known
  double length = 0;            ///< between the two in plan [m]
  double travel_tangent = 0;    ///< drop over distance of the centre of mass [-]; 0: no deposit is known
  double head = 0;              ///< largest height of the energy line from crown to deposit above the ground [m]

  bool has_deposit() const { return length > 0; }
};

/// Measures a slide. `before` is the surface before it, `release` the vertical thickness of what fails, `deposit` that
/// of what rose (empty: not known), all on one grid [m].
Slide measure_slide(const Raster& before, const Raster& release, const std::optional<Raster>& deposit);

/// The tangent of the Fahrboeschung, height over length of fall, that is usual for a volume [m3]: Scheidegger (1973)
/// for 1e5 m3 and more, Corominas (1996), all of his landslides, for less [-].
double usual_reach_tangent(double volume);

/// What a first recipe proposes.
struct Proposal {
  double spacing = 0;         ///< of the cells [m]
  double layer_height = 0;    ///< [m]
  double layers = 0;          ///< over the median thickness
  double cells_across = 0;    ///< over the width of the release
  double bed_angle = 0;       ///< [deg]
  double internal_angle = 0;  ///< [deg]
  double end_time = 0;        ///< [s]
  double points = 0;          ///< material points, eight in a cell
};

/// Spacing: twenty cells across the release, but not finer than the models, unless eight need it. Layers: four and a
/// half or more over the median thickness, none higher than a cell is wide. Bed: the angle at which the centre of mass
/// went, or the usual Fahrboeschung. Inside: 1.4 times its tangent (material-laws.md). End: four times the way over
/// the largest speed that the energy line allows, twice what a block takes that speeds up and slows down evenly.
Proposal propose(const Slide& slide);

}  // namespace talus::command
