// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Owner of the background grid: terrain, storage of the columns that hold material, points sorted by column block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/grid/terrain.hpp"
#include "solver/state/particles.hpp"

namespace talus {

/// The way that a point reaches: what it may go before it is sorted again, and its stencil.
struct Reach {
  int columns;  ///< along x and y
  int layers;
};

/// The owner of the blocks' places in storage. A block has storage for all of its columns, from the lowest to the
/// highest layer that any point near it reaches, or none.
template <class Device>
class BlockStorage {
 public:
  /// The constructor makes the storage of a map without points: no block has any.
  BlockStorage(const Device& device, int columns, int rows);

  /// The method gives storage to every column and layer within `reach` of a point, and takes it from all others.
  template <class Real>
  void fit(const ParticleView<Real>& points, const Reach& reach);

  /// The place in storage of every block, [blocks in y * blocks in x] on the device.
  const BlockSlot* slots() const { return slots_.data(); }
  int nodes() const { return nodes_; }           ///< number of stored nodes
  int active_blocks() const { return active_; }  ///< number of blocks with storage
  /// The blocks with storage, [active_blocks()] on the device.
  const int* active_list() const { return active_list_.data(); }
  std::size_t bytes() const { return bytes_of(slots_, lowest_, highest_, upto_, active_list_); }

 private:
  template <class Real>
  void measure_extents(const ParticleView<Real>& points, const Reach& reach);
  void give_storage();

  Device device_;
  int columns_, rows_;
  int nodes_ = 0, active_ = 0;
  Buffer<BlockSlot, Device> slots_{device_};
  Buffer<int, Device> lowest_{device_}, highest_{device_};  ///< layers that a block needs
  Buffer<std::uint64_t, Device> upto_{device_};             ///< nodes and blocks in use up to a block
  Buffer<int, Device> active_list_{device_};
};

/// The tables of the terrain in the precision of the kernels; they do not change during a run.
template <class Real, class Device>
class DeviceTerrain {
 public:
  DeviceTerrain(const Device& device, const TerrainTables& tables)
      : elevation_(device), slope_x_(device), slope_y_(device), open_(device) {
    upload_as(elevation_, tables.terrain);
    upload_as(slope_x_, tables.slope_x);
    upload_as(slope_y_, tables.slope_y);
    open_.upload(tables.open);
  }

  /// The method gives the tables to a grid as kernels see it.
  void show(GridView<Real>& grid) const {
    grid.terrain = elevation_.data();
    grid.slope_x = slope_x_.data();
    grid.slope_y = slope_y_.data();
    grid.open = open_.data();
  }

  std::size_t bytes() const { return elevation_.bytes() + slope_x_.bytes() + slope_y_.bytes() + open_.bytes(); }

 private:
  Buffer<Real, Device> elevation_;  ///< spline coefficients at the nodes [m]
  Buffer<Real, Device> slope_x_, slope_y_;
  Buffer<unsigned char, Device> open_;
};

/// The sort of the points by home cell, and what it leaves: the cells they were sorted by, and the ranges of those that
/// may be scattered at the same time.
template <class Real, class Device>
class ParticleOrder {
 public:
  struct Rules {
    bool in_order = false;        ///< a GPU goes by the ranges too, so that sums are the same on every run
    bool by_lowest_node = false;  ///< the home is the cell of a point's lowest node, not of its nearest one
  };
  /// The constructor takes the rules and the size of the map [nodes].
  ParticleOrder(const Device& device, int columns, int rows, const Rules& rules);

  /// The method sorts the points by home cell and drops those that left: the `outflow_count` last ones after sorting.
  void sort(Particles<Real, Device>& points, int outflow_count);

  /// Whether points were sorted by the cell of their lowest node. No order but that of a GPU without ranges does so.
  bool by_lowest_node() const { return by_lowest_node_; }
  /// The keys of the cells that the points were sorted by (home_key()), [points] on the device.
  const std::uint64_t* home() const { return keys_.data(); }
  /// The same keys on the host; waits for the device.
  std::vector<std::uint64_t> homes() const { return keys_.download(); }
  const PointGroups& groups() const { return groups_; }  ///< ranges of points by column block and colour
  std::size_t bytes() const { return order_.bytes() + keys_.bytes(); }

 private:
  void group_points(int count);

  Device device_;
  int blocks_x_, blocks_;
  bool by_lowest_node_;
  Buffer<int, Device> order_{device_};
  Buffer<std::uint64_t, Device> keys_{device_};
  PointGroups groups_;
};

/// The way that a point may go from home before it is sorted again.
struct Drift {
  int columns = 1;  ///< along x and y [cells]
  int layers = 1;
};

/// The background grid with its storage, and the order of the points in it.
template <class Real, class Device>
class SparseGrid {
 public:
  /// Makes a grid without points. `drift` is how far a point may go from home before it is sorted again, at most one on
  /// the CPU, where blocks of the same colour are four columns apart. With `in_order` scatters give the same bits on
  /// every run on a GPU too; the drift is at most one there as well. With `by_lowest_node` points are sorted by the
  /// lowest of their nodes, where no order asks for more: with hats, those of one cell do not have the same nodes.
  SparseGrid(const Device& device, const GridShape& shape, const Drift& drift, bool in_order = false,
             bool by_lowest_node = false);

  /// Sorts the points by home cell, drops those that left (the `outflow_count` last ones after sorting), halves those
  /// drawn out too far, and gives storage to every column and layer they reach until they have drifted too far.
  void fit(Particles<Real, Device>& points, int outflow_count);

  const Device& device() const { return device_; }        ///< device that the grid is on
  GridView<Real> view() const;                            ///< grid as kernels see it, until the next fit()
  const Drift& drift() const { return drift_; }           ///< see SparseGrid()
  void set_drift(const Drift& drift) { drift_ = drift; }  ///< from the next fit() on
  /// The method sets the nodes at which material is met from now on.
  void set_walls(const WallNodes& nodes) { walls_ = nodes; }
  const TerrainTables& ground() const { return tables_; }  ///< terrain as kernels use it, on the host
  const GridShape& shape() const { return shape_; }        ///< shape of the grid
  /// The keys of the cells that the points were sorted by (home_key()), [points] on the device.
  const std::uint64_t* home() const { return order_.home(); }
  /// The same keys on the host; waits for the device.
  std::vector<std::uint64_t> homes() const { return order_.homes(); }
  /// The ranges of points by column block and colour.
  const PointGroups& groups() const { return order_.groups(); }
  int nodes() const { return storage_.nodes(); }                  ///< number of stored nodes
  int active_blocks() const { return storage_.active_blocks(); }  ///< number of column blocks with storage
  /// The column blocks with storage, [active_blocks()] on the device.
  const int* active_list() const { return storage_.active_list(); }
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
