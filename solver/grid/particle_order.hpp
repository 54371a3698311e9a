// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The order of the particles: by home cell, block of columns by block of columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particles.hpp"

namespace talus {

/// The sort of the points by home cell, and what it leaves: the cells they were sorted by, and the ranges of those that
/// may be scattered at the same time.
template <class Real, class Device>
class ParticleOrder {
 public:
  /// The rules that points are sorted by.
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
  /// The ranges of points by column block and colour.
  const PointGroups& groups() const { return groups_; }
  /// The size of keys and order [bytes].
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

}  // namespace talus
