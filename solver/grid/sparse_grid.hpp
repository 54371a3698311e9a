// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Owner of the background grid: terrain, storage of the columns that hold material, points sorted by column block.
#pragma once

#include <vector>

#include "solver/grid/block_storage.hpp"
#include "solver/grid/device_terrain.hpp"
#include "solver/grid/particle_order.hpp"
#include "solver/grid/terrain.hpp"

namespace talus {

/// The way that a point may go from home before it is sorted again.
struct Drift {
  int columns = 1;  ///< along x and y [cells]
  int layers = 1;
};

/// The background grid with its storage, and the order of the points in it.
template <class Real, class Device>
class SparseGrid {
 public:
  /// The constructor makes a grid without points. `drift` is how far a point may go from home before it is sorted
  /// again, at most one on the CPU, where blocks of the same colour are four columns apart. With `in_order` scatters
  /// give the same bits on every run on a GPU too; the drift is at most one there as well. With `by_lowest_node` points
  /// are sorted by the lowest of their nodes, where no order asks for more: with hats, those of one cell do not have
  /// the same nodes.
  SparseGrid(const Device& device, const GridShape& shape, const Drift& drift, bool in_order = false,
             bool by_lowest_node = false);

  /// The method sorts the points by home cell, drops those that left (the `outflow_count` last ones after sorting), and
  /// gives storage to every column and layer they reach until they have drifted too far.
  void fit(Particles<Real, Device>& points, int outflow_count);

  /// The device that the grid is on.
  const Device& device() const { return device_; }
  /// The grid as kernels see it, until the next fit().
  GridView<Real> view() const;
  /// The method sets the nodes at which material is met from now on.
  void set_walls(const WallNodes& nodes) { walls_ = nodes; }
  /// The terrain as kernels use it, on the host.
  const TerrainTables& ground() const { return tables_; }
  /// The shape of the grid.
  const GridShape& shape() const { return shape_; }
  /// The keys of the cells that the points were sorted by (home_key()), [points] on the device.
  const std::uint64_t* home() const { return order_.home(); }
  /// The same keys on the host; waits for the device.
  std::vector<std::uint64_t> homes() const { return order_.homes(); }
  /// The ranges of points by column block and colour.
  const PointGroups& groups() const { return order_.groups(); }
  /// The number of stored nodes.
  int nodes() const { return storage_.nodes(); }
  /// The number of column blocks with storage.
  int active_blocks() const { return storage_.active_blocks(); }
  /// The column blocks with storage, [active_blocks()] on the device.
  const int* active_list() const { return storage_.active_list(); }
  /// The size of the storage and of the tables [bytes].
  std::size_t bytes() const { return terrain_.bytes() + storage_.bytes() + order_.bytes(); }

 private:
  Device device_;
  GridShape shape_;
  Drift drift_;
  TerrainTables tables_;
  WallNodes walls_;
  DeviceTerrain<Real, Device> terrain_;
  BlockStorage<Device> storage_;
  ParticleOrder<Real, Device> order_;
};

}  // namespace talus
