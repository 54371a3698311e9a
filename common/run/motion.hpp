// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What of a run is in motion, from the points in run.h5.
#pragma once

#include <filesystem>
#include <vector>

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
/// (point_frames = false). Throws DataError: unreadable.
Motion read_motion(const std::filesystem::path& run_file, double faster_than);

}  // namespace talus
