// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured of the particles as a whole: energies, thickness on the map, volumes over the columns, and packing,
// the volume of the points in a cell about a node over the room in it. Sums over shape functions would not do for
// packing: what drifts within a cell is what they do not see.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/integrator/point_sums.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/host_room.hpp"

namespace talus::solver {

/// Volumes are summed in whole parts of a cell, so that the sum is the same in any order.
using CellParts = unsigned long long;
inline constexpr double parts_of_cell = 16777216;
/// The bins of packing, and how many there are to 1; the last one holds all that is denser.
inline constexpr int packing_bins = 1024, packing_bins_to_one = 100;

/// One thread: one point. Its initial volume goes to the cell of its nearest node [parts of a cell].
template <class Real>
struct ScatterParts {
  GridView<Real> grid;
  ParticleView<Real> points;
  CellParts* parts;

  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p], j = points.cell[1][p];
    if (i < 0) return;
    const double cell =
        static_cast<double>(grid.spacing) * static_cast<double>(grid.spacing) * static_cast<double>(grid.layer_height);
    const auto held = static_cast<CellParts>(floor(static_cast<double>(points.volume[p]) / cell * parts_of_cell + 0.5));
    scatter_add(&parts[GridView<Real>::node(grid.slot(i, j), i, j, points.cell[2][p])], held);
  }
};

/// The room about a node in one direction [cells], `from_edge` nodes from one where the matter must end.
TALUS_HD double room_along(int from_edge) { return from_edge == 0 ? 0.5 : 1.0; }

/// One thread: one column. The packing of its cells goes into bins by the volume in them [parts of a cell], the largest
/// is kept. Cells that the ground of a Cartesian grid cuts count as whole ones.
template <class Real>
struct BinPacking {
  GridView<Real> grid;
  const int* active;
  const CellParts* parts;
  CellParts* bins;      ///< [packing_bins]
  std::uint32_t* most;  ///< largest, as float bits

  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const BlockSlot slot = grid.slots[at.block];
    const WallNodes& w = grid.walls;
    const double across =
        room_along(nearest(at.i - w.west, w.east - at.i)) * room_along(nearest(at.j - w.south, w.north - at.j));
    double largest = 0;
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      const CellParts held = parts[GridView<Real>::node(slot, at.i, at.j, k)];
      if (held == 0) continue;
      const double packing = static_cast<double>(held) / parts_of_cell / (across * room_along(k));
      const double bin = packing * packing_bins_to_one;
      add_to_bin(&bins[bin < packing_bins - 1 ? static_cast<int>(bin) : packing_bins - 1], held);
      largest = packing > largest ? packing : largest;
    }
    atomic_max_positive(most, static_cast<float>(largest));
  }

 private:
  TALUS_HD static int nearest(int a, int b) { return a < b ? a : b; }
};

/// What is summed over the cells, side by side so that it is cleared and read at once.
struct PackingSums {
  CellParts bins[packing_bins];
  std::uint32_t most;  ///< largest, as float bits
};

/// The packing by its bins [parts of a cell] and the largest of all.
inline Packing packing_of(std::span<const CellParts> bins, double largest) {
  CellParts total = 0, denser = 0;
  for (const CellParts held : bins) total += held;
  std::size_t bin = bins.size();
  while (bin > 0 && 100 * (denser + bins[bin - 1]) <= total) denser += bins[--bin];
  // The bin below holds what lies on both sides: its upper end.
  return {std::min(largest, static_cast<double>(bin) / packing_bins_to_one), largest};
}

/// The sums and maps that are made of the particles when they are asked for, with the memory that takes.
template <class Real, class Device, class Shape>
class ParticleMeasures {
 public:
  using Energy = MeasureEnergies<Real, Shape>;  ///< what is summed over the particles

  /// The constructor takes the grid whose cells the maps have.
  ParticleMeasures(const Device& device, const GridShape& shape)
      : device_(device), columns_(shape.columns), rows_(shape.rows), spacing_(shape.spacing) {
    sums_.ticket();
  }

  /// The method starts the sums over `count` particles.
  void start_energies(int count, const Energy& measure) {
    const ProfilePhase<Device> phase(device_, "records and frames");
    sum_each<Energy::rows>(device_, count, sums_, measure, KeepTotals<Energy::rows>{(*room_).value});
  }
  /// The sums that were started last; waits for the device.
  Energies energies() const {
    synchronise(device_);
    const double(&total)[Energy::rows] = (*room_).value;
    return {total[0], total[1], total[2], total[3], {total[4], total[5], total[6]}, total[7], total[8]};
  }

  /// The vertical thickness, h of (T25), [rows * columns] [m]; waits for the device. The ranges of the particles are
  /// those of the grid they were sorted for.
  std::vector<double> thickness(const ParticleView<Real>& points, const PointGroups& groups) {
    const ProfilePhase<Device> phase(device_, "records and frames");
    scatter(points, groups, thickness_);
    std::vector<double> result = thickness_.download();
    for (double& value : result) value /= spacing_ * spacing_;
    return result;
  }

  /// The method starts to measure how densely the particles are packed in a grid that was sorted for them.
  template <class Grid>
  void start_packing(const ParticleView<Real>& points, Grid& grid) {
    const ProfilePhase<Device> phase(device_, "records and frames");
    parts_.resize_zeroed(static_cast<std::size_t>(grid.nodes()));
    packing_sums_.resize_zeroed(1);
    PackingSums* const sums = packing_sums_.data();
    for_each_grouped(device_, points.count, grid.groups(), ScatterParts<Real>{grid.view(), points, parts_.data()});
    for_each(device_, grid.active_blocks() * block_columns,
             BinPacking<Real>{grid.view(), grid.active_list(), parts_.data(), sums->bins, &sums->most});
  }
  /// The packing whose measure was started last; waits for the device.
  Packing packing() const {
    const PackingSums total = packing_sums_.download().front();
    return packing_of(total.bins, static_cast<double>(positive_from_bits(total.most)));
  }

  /// Measures the volumes over the columns, where densities of particles differ: mass does not give their thickness.
  void measure_columns(const ParticleView<Real>& points, const PointGroups& groups) {
    scatter(points, groups, column_volumes_);
  }
  /// The volumes over the columns as measured last, [rows * columns] on the device [m3]; null where they never were.
  const double* column_volumes() const { return column_volumes_.data(); }

  /// The memory for partial sums, which others on the device may use between calls.
  SumSpace<Device>& sums() { return sums_; }
  std::size_t bytes() const { return bytes_of(sums_, column_volumes_, thickness_, parts_, packing_sums_); }

 private:
  void scatter(const ParticleView<Real>& points, const PointGroups& groups, Buffer<double, Device>& volumes) {
    volumes.resize_zeroed(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for_each_grouped(device_, points.count, groups, ScatterThickness<Real, Shape>{points, columns_, volumes.data()});
  }

  Device device_;
  int columns_, rows_;
  double spacing_;  ///< [m]
  Buffer<double, Device> thickness_{device_}, column_volumes_{device_};
  SumSpace<Device> sums_{device_};
  HostRoom<Terms<Energy::rows>, Device> room_{device_};
  Buffer<CellParts, Device> parts_{device_};
  Buffer<PackingSums, Device> packing_sums_{device_};
};

}  // namespace talus::solver
