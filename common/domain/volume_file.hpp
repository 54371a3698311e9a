// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Density and velocity as sparse volumes in an OpenVDB file, for Blender, Houdini and ParaView.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Cubic voxels along the axes: east, north, up. Voxel (i, j, k) fills the cube from `side` * (i, j, k) on, measured
/// from `origin`. Those that are not listed are empty.
struct VolumeFile {
  double time = 0;                                  ///< [s]
  std::string run_id = {};                          ///< of the run
  std::string crs = {};                             ///< its name; empty: local coordinates
  std::array<double, 3> origin{};                   ///< map coordinates and elevation where the volume's are 0 [m]
  double side = 1;                                  ///< of a voxel [m]
  std::vector<std::array<int, 3>> voxels = {};      ///< each once
  std::vector<float> density = {};                  ///< mass over the voxel's volume [kg/m3]
  std::vector<std::array<float, 3>> velocity = {};  ///< momentum over mass [m/s]
};

/// This function writes the float grid "density" and the vector grid "velocity", both sparse and 0 outside, aside and
/// renamed. Coordinates of the file are metres from `origin`, whose numbers stand in the metadata of both grids
/// (origin_x_m, origin_y_m, origin_z_m), beside "time_s", "run_id", "crs" and "unit". It throws DataError when the file
/// cannot be written.
void write_volume_file(const std::filesystem::path& path, const VolumeFile& volume);

}  // namespace talus
