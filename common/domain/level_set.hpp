// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies given as OpenVDB level sets: signed distance to their surface [m], negative inside, over map coordinates and
// elevation. OpenVDB stays behind level_set.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A flat piece of a surface.
struct Facet {
  std::array<double, 3> centre;  // map coordinates and elevation [m]
  std::array<double, 3> area;    // along the outward normal [m2]
};

struct BodySurface {
  std::vector<Facet> facets;
  double volume = 0;                                                             // enclosed [m3]
  std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};  // bounding box [m]
};

/// The zero surface of the level set called `grid` in `file`; with an empty name, of the only one there is. Facets are
/// no longer than `largest` along each axis [m]. OpenVDB crashes on some damaged files of other programs
/// (common/stage/signals.hpp). Throws DataError: no such file or grid, damaged, several grids and no name, not a
/// level set, distances that are not finite, voxels without a size, no surface.
BodySurface read_level_set(const std::filesystem::path& file, const std::string& grid,
                           const std::array<double, 3>& largest);

/// A body to be written: from `low` to `high`, where `distance` is negative. Distances are exact beside it.
struct SolidBody {
  std::string name;
  std::array<double, 3> low, high;                         // [m]
  std::function<double(double, double, double)> distance;  // [m]
};

/// A body that a run reads from memory, in voxels of `voxel` [m]; null where it reads a file.
struct VoxelBody {
  SolidBody body;
  double voxel;
};
using BodyInMemory = std::shared_ptr<const VoxelBody>;

/// The surface of a body, as read_level_set() gives it from a file of write_level_sets(). Throws DataError: a body that
/// no voxel lies in, or too large for such facets.
BodySurface surface_of(const VoxelBody& body, const std::array<double, 3>& largest);

/// All into one file (aside, renamed), in voxels of `voxel` [m]. Throws DataError: no voxel lies in a body; disk full.
void write_level_sets(const std::filesystem::path& file, const std::vector<SolidBody>& bodies, double voxel);

}  // namespace talus
