// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Material points of a run, frame by frame.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace talus::validation {

/// Index = id; a point that left the domain has NaN for a position.
struct Points {
  double time = 0;                              // [s]
  std::vector<std::array<double, 3>> position;  // [m]
  std::vector<std::array<float, 3>> velocity;   // [m/s]
  std::vector<float> volume;                    // initial [m3]
  std::vector<float> pressure;                  // minus the mean Kirchhoff stress [Pa]
  std::size_t size() const { return position.size(); }
};

/// From group VTKHDF of run.h5; none where it has no frames of points, as a search for a factor. Throws DataError.
std::vector<Points> read_points(const std::filesystem::path& run);

/// Where a deposit along x ends: the last point before a gap of one cell, and half a point more (single grains roll on)
/// [m].
double front_of(const Points& points, double cell, double point_spacing);

/// How far along x 99 of 100 points got [m]. Where a deposit ends is less: its tip is strings of points a cell apart,
/// and chance says where they tear. Points that left do not count; there must be one.
double reach_of(const Points& points);

}  // namespace talus::validation
