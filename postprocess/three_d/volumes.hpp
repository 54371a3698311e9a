// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The mass on the nodes of the solver's sparse grid, whose layers follow the terrain, brought to cubic voxels.
#pragma once

#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

#include "common/domain/volume_file.hpp"
#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Voxels that divide the cells of a map, and the bed that the layers follow.
class Voxels {
 public:
  /// `side` is that of a voxel [m]; 0: the cell, divided until it is no larger than a layer. Throws DataError where it
  /// is no whole part of the cell.
  Voxels(const Run& run, double side);

  /// Side of a voxel [m].
  double side() const { return side_; }
  /// Height of the layers [m]; of files that do not say it, the cell.
  double layer_height() const { return layer_height_; }
  /// Where the volume's coordinates are 0: the map's corner, at a whole voxel below the lowest ground [m].
  const std::array<double, 3>& origin() const { return origin_; }
  /// Voxels for each side of a cell.
  int division() const { return division_; }

  /// Density and velocity of a frame. Points give mass and momentum to the nodes around them by hats along the axes of
  /// the grid, x, y and the height above the bed (a node of layer k stands at k layers above it; the base node has half
  /// a cell). Then each node's share goes to the voxels that its sheared cell covers, by the volume in each. Both steps
  /// keep mass and momentum.
  VolumeFile volume(const Run& run, const PointFrame& points) const;

 private:
  using Node = std::array<double, 4>;  ///< mass [kg], momentum [kg m/s]
  using Column = std::vector<Node>;    ///< by layer

  std::unordered_map<std::size_t, Column> nodes_of(const Run& run, const PointFrame& points) const;
  double bed_at(double x, double y) const;
  void add_column(std::size_t cell, const Column& column, VolumeFile& volume) const;
  void add_part(const std::array<int, 2>& place, double bed, const Column& column, VolumeFile& volume) const;

  MapGrid grid_;
  std::vector<double> bed_;  // [m], at every cell
  double layer_height_, side_;
  int division_;
  std::array<double, 3> origin_;
};

}  // namespace talus::postprocess
