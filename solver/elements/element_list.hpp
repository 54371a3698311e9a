// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elements: the points whose stencils start at the same node, with the W^3 nodes they share (W = Shape::width).
//
// Elements are sorted by the column block of their first node. Their nodes lie in that block and the next one along x
// and y, so elements of every other block share none: for_each_grouped(..., groups(), ...) runs them race-free on the
// CPU, in one order.
#pragma once

#include <cstdint>

#include "solver/grid/shape_functions.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver {

/// The elements as kernels read them. Local nodes are numbered as around() visits them: layer fastest, then x, then y.
/// Where layer -1 is folded onto layer 0, local nodes (a, b, 0) and (a, b, 1) are one and the same.
struct ElementView {
  int count = 0;
  const int* starts = nullptr;  ///< element e holds points order[starts[e]] ... order[starts[e + 1] - 1]
  const int* order = nullptr;
  const int* nodes = nullptr;  ///< [element * W^3 + local node]
};

/// The elements of the points with their storage.
template <class Real, class Device, class Shape>
class ElementList {
 public:
  static constexpr int width = Shape::width;
  static constexpr int nodes_each = width * width * width;

  explicit ElementList(const Device& device) : device_(device) {}

  /// The method groups the points of a grid that has been fitted to them. Serial numbers count the builds.
  void build(const GridView<Real>& grid, const ParticleView<Real>& points);

  /// The elements as kernels read them, until the next build().
  ElementView view() const { return {count_, starts_.data(), order_.data(), nodes_.data()}; }
  const Device& device() const { return device_; }  ///< device that the elements are on
  int count() const { return count_; }              ///< number of elements
  int serial() const { return serial_; }            ///< number of the last build
  /// The ranges of elements by colour of their column block; empty on the GPU, where sums are atomic.
  const PointGroups& groups() const { return groups_; }
  std::size_t bytes() const { return bytes_of(keys_, order_, starts_, nodes_, scratch_); }

 private:
  Device device_;
  int count_ = 0, serial_ = 0;
  Buffer<std::uint64_t, Device> keys_{device_};
  Buffer<int, Device> order_{device_}, starts_{device_}, nodes_{device_}, scratch_{device_};
  PointGroups groups_;
};

}  // namespace talus::solver
