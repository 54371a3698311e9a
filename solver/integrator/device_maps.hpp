// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The running maps in the memory of a device.
#pragma once

#include <cstddef>
#include <vector>

#include "common/run/map_fields.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// The maps that kernels keep while a run goes on, [rows * columns] each.
template <class Device>
class DeviceMaps {
 public:
  /// The constructor copies the maps that the run starts from; `threshold` is the thickness from which speed, pressure
  /// and arrival count [m].
  DeviceMaps(const Device& device, const RunningMaps<std::vector<double>>& start, double threshold)
      : maps_(make_running_maps<Buffer<double, Device>>(device)), threshold_(threshold) {
    for_each_running_map([](const RunningMap&, auto& buffer, const auto& values) { buffer.upload(values); }, maps_,
                         start);
  }

  /// The maps as kernels see them.
  MapView view() {
    MapView view;
    for_each_running_map([](const RunningMap&, double*& values, auto& buffer) { values = buffer.data(); }, view, maps_);
    view.threshold = threshold_;
    return view;
  }

  /// The maps so far; waits for the device.
  RunningMaps<std::vector<double>> download() const {
    RunningMaps<std::vector<double>> all;
    for_each_running_map([](const RunningMap&, auto& values, const auto& buffer) { values = buffer.download(); }, all,
                         maps_);
    return all;
  }

  /// The size of the maps [bytes].
  std::size_t bytes() const {
    std::size_t total = 0;
    for_each_running_map([&](const RunningMap&, const auto& buffer) { total += buffer.bytes(); }, maps_);
    return total;
  }

 private:
  RunningMaps<Buffer<double, Device>> maps_;
  double threshold_;
};

}  // namespace talus::solver
