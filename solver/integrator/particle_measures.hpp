// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured of the particles as a whole: energies, thickness on the map, packing, volumes over the
// columns.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/grid/terrain.hpp"
#include "solver/integrator/packing.hpp"
#include "solver/integrator/point_sums.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/parallel/sums.hpp"

namespace talus::solver {

/// The sums and maps that are made of the particles when they are asked for, with the memory that takes.
template <class Real, class Device, class Shape>
class ParticleMeasures {
 public:
  using Energy = MeasureEnergies<Real, Shape>;  ///< what is summed over the particles

  /// The constructor takes the grid whose cells the maps have.
  ParticleMeasures(const Device& device, const GridShape& shape)
      : device_(device), columns_(shape.columns), rows_(shape.rows), spacing_(shape.spacing), packing_(device) {
    totals_.resize(Energy::rows);
    sums_.ticket();
  }

  /// The method starts the sums over `count` particles.
  void start_energies(int count, const Energy& measure) {
    const ProfilePhase<Device> phase(device_, "records and frames");
    sum_each<Energy::rows>(device_, count, sums_, measure, KeepTotals<Energy::rows>{totals_.data()});
    room_.copy_from(reinterpret_cast<const Totals*>(totals_.data()));
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
    packing_.start(points, grid);
  }
  /// The packing whose measure was started last; waits for the device.
  Packing packing() const { return packing_.read(); }

  /// The method measures the volumes over the columns, for the maps of particles whose densities differ: mass does not
  /// give their thickness.
  void measure_columns(const ParticleView<Real>& points, const PointGroups& groups) {
    scatter(points, groups, column_volumes_);
  }
  /// The volumes over the columns as they were measured last, [rows * columns] on the device [m3]; null where they
  /// never were.
  const double* column_volumes() const { return column_volumes_.data(); }

  /// The memory for partial sums, which others on the device may use between calls.
  SumSpace<Device>& sums() { return sums_; }
  /// The size of maps and partial sums [bytes].
  std::size_t bytes() const { return sums_.bytes() + column_volumes_.bytes() + thickness_.bytes() + packing_.bytes(); }

 private:
  void scatter(const ParticleView<Real>& points, const PointGroups& groups, Buffer<double, Device>& volumes) {
    volumes.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    volumes.fill_zero();
    for_each_grouped(device_, points.count, groups, ScatterThickness<Real, Shape>{points, columns_, volumes.data()});
  }

  using Totals = Terms<Energy::rows>;
  Device device_;
  int columns_, rows_;
  double spacing_;  ///< [m]
  Buffer<double, Device> totals_{device_}, thickness_{device_}, column_volumes_{device_};
  SumSpace<Device> sums_{device_};
  HostRoom<Totals, Device> room_{device_};
  PackingMeasure<Real, Device> packing_;
};

}  // namespace talus::solver
