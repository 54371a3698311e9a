// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far and how low the mass went.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus {

/// A place on the ground [m].
struct Place {
  double x = 0, y = 0, z = 0;
};

/// A release cell is one thicker at the start than this: the deposit threshold, or a tenth of the thickest where the
/// whole release is thin [m].
double release_limit(const RunMaps& maps, double threshold);

/// Highest cell of the release (see release_limit) on the surface before the failure; of an edge that is level, its
/// middle. Empty without a release.
std::optional<Place> crown(const RunMaps& maps, double threshold);

/// The cell centre above `threshold` farthest (in plan, as the crow flies) from `from`; z is taken from `surface`,
/// which has the same grid (empty: z = 0). Empty where no cell exceeds the threshold.
std::optional<Place> farthest(const MapGrid& grid, const std::vector<double>& values, double threshold,
                              const Place& from, const std::vector<double>& surface);

/// Distance of two places on the map [m].
double plan_distance(const Place& a, const Place& b);

/// Centre of mass of a thickness map lying on `bed` (z at half thickness; empty: z = 0). Empty without any mass.
std::optional<Place> centre_of_mass(const MapGrid& grid, const std::vector<double>& thickness,
                                    const std::vector<double>& bed);

}  // namespace talus
