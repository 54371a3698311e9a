// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points with attributes in an OpenVDB file of their own, for Houdini, Blender and ParaView.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace talus {

/// The values of an attribute, one for each point.
using PointValues = std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::array<float, 3>>>;

/// The points of a file.
struct PointFile {
  double time = 0;                               ///< [s]
  std::string run_id = {};                       ///< of the run that the points are of
  double voxel = 1;                              ///< size of the voxels that the points are sorted into [m]
  std::vector<std::array<double, 3>> positions;  ///< [m]
  std::vector<std::pair<std::string, PointValues>> attributes;  ///< by name
};

/// This function writes `points` as the PointDataGrid "points", aside and renamed; "time_s" and "run_id" stand in its
/// metadata. It throws DataError when the file cannot be written.
void write_point_file(const std::filesystem::path& path, const PointFile& points);

}  // namespace talus
