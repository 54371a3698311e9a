// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Storage of the nodes: which blocks of columns hold material, over which layers, and where their nodes lie.
#pragma once

#include <cstddef>

#include "solver/parallel/buffer.hpp"
#include "solver/state/grid_view.hpp"
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
  /// The number of stored nodes.
  int nodes() const { return nodes_; }
  /// The number of blocks with storage.
  int active_blocks() const { return active_; }
  /// The blocks with storage, [active_blocks()] on the device.
  const int* active_list() const { return active_list_.data(); }
  /// The size of the tables [bytes].
  std::size_t bytes() const;

 private:
  template <class Real>
  void measure_extents(const ParticleView<Real>& points, const Reach& reach);
  void give_storage();

  Device device_;
  int columns_, rows_;
  int nodes_ = 0, active_ = 0;
  Buffer<BlockSlot, Device> slots_{device_};
  Buffer<int, Device> lowest_{device_}, highest_{device_};  ///< layers that a block needs
  Buffer<int, Device> sizes_{device_}, places_{device_};  ///< nodes of a block, then before it; blocks in use before it
  Buffer<int, Device> active_list_{device_};
};

}  // namespace talus
