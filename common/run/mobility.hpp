// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far and how low the mass went, and how much of it is still in motion.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus {

/// What is slower creeps or rests [m/s]: `moving_volume_m3` and `moving_speed_m_s` of a history count what is faster.
inline constexpr double moving_faster_than = 1.0;

/// Volume of the points that move at each frame of the points.
struct Motion {
  std::vector<double> time;        ///< [s]
  std::vector<double> volume;      ///< of points faster than the speed asked for [m3]
  std::vector<double> mean_speed;  ///< of all of these, by volume [m/s]; 0 where none moves
};

/// Read velocity and volume of the points, a part at a time. Empty where the run has no frames of points
/// (point_frames = "none"). Throws DataError: unreadable.
Motion read_motion(const std::filesystem::path& run_file, double faster_than);

/// A place on the ground [m].
struct Place {
  double x = 0, y = 0, z = 0;
};

/// The thickness above which a cell counts as covered where the recipe names none, for footprint, deposit, run-out,
/// arrival and ensembles alike [m]: 0.1 m, or 5 % of the median thickness of the released cells where that is less, to
/// two digits. `release`: released thickness of the cells [m]; nothing released: 0.1 m.
double covering_thickness(std::vector<double> release);

/// A release cell is one thicker at the start than this: the deposit threshold, or a tenth of the thickest where the
/// whole release is thin [m].
double release_limit(const RunMaps& maps, double threshold);

/// Highest cell of the release on the surface before the failure; of a level edge its middle. Empty without a release.
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
