// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain of a grid in the memory of a device.
#pragma once

#include "solver/grid/terrain.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// The tables of the terrain in the precision of the kernels; they do not change during a run.
template <class Real, class Device>
class DeviceTerrain {
 public:
  /// The constructor copies the tables to the device.
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

  /// The size of the tables [bytes].
  std::size_t bytes() const { return elevation_.bytes() + slope_x_.bytes() + slope_y_.bytes() + open_.bytes(); }

 private:
  Buffer<Real, Device> elevation_;  ///< spline coefficients at the nodes [m]
  Buffer<Real, Device> slope_x_, slope_y_;
  Buffer<unsigned char, Device> open_;
};

}  // namespace talus
