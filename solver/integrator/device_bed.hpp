// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's friction in the memory of a device.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/boundary/base_friction.hpp"
#include "solver/parallel/buffer.hpp"

namespace talus::solver {

/// The bed's friction and, where it changes from place to place, its numbers beside the grid.
template <class Number, class Device>
class DeviceBed {
 public:
  /// The constructor takes the law with the numbers that hold everywhere, and those of every column in their place
  /// where there are any, [rows * columns].
  DeviceBed(const Device& device, const BaseFriction<double>& friction, const std::vector<Bed<double>>& columns)
      : friction_(friction.as<Number>()), columns_(device) {
    if (columns.empty()) return;
    std::vector<Bed<Number>> beds;
    beds.reserve(columns.size());
    for (const Bed<double>& bed : columns) beds.push_back(bed.as<Number>());
    columns_.upload(beds);
    friction_.columns = columns_.data();
  }
  /// The friction as kernels see it.
  BaseFriction<Number> view() const { return friction_; }
  /// The size of the numbers beside the grid [bytes].
  std::size_t bytes() const { return columns_.bytes(); }

 private:
  BaseFriction<Number> friction_;
  Buffer<Bed<Number>, Device> columns_;
};

}  // namespace talus::solver
