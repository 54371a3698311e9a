// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure of the water in the pores of every column of the grid (T50): points give their effective stress to the
// cells of the column, there water flows along it, and points take the change of their effective stress back, and the
// volume that the water brought.
#pragma once

#include <optional>
#include <vector>

#include "solver/water/flow_along_columns.hpp"

namespace talus {

/// One thread: one point. It takes what its cells answer: its effective stress, at its first step with water that of
/// the `table` of the water, its share of strength, and the volume that water brings, `at_once` or until the next step
/// with water.
template <class Real, class Shape>
struct WaterToPoints : WaterStep<Real> {
  using Base = WaterStep<Real>;
  using Base::clock, Base::grid, Base::points, Base::water;
  const Vec4<Real>* answers;
  const float* table;  ///< depth of the water table at the start, normal to the bed, [rows * columns] [m]
  Real ratio;          ///< of the pressure to the load at the start; negative: hydrostatic
  Real density;        ///< of the mass [kg/m3]
  Real stiffness;      ///< of the stiffest undrained mass across the bed [Pa]
  bool at_once;

  TALUS_HD void operator()(int p) const {
    if (!this->is_due() || points.cell[0][p] < 0) return;
    const CellsAround<Real, Shape> at(grid, points, p);
    const CellAnswer<Real> answer = gather(at, points.offset[2][p]);
    if (!(answer.load > Real(0))) {
      points.water_strength[p] = Real(1);
      points.water_due[p] = points.water_inflow[p] = Real(0);
      return;
    }
    Real effective = points.effective_stress[p];
    if (effective < Real(no_water - 0.5)) {
      effective = first(p, at, answer.load);
    } else if (effective >= Real(0)) {
      effective += answer.change;
      const Real most = Real(2) * answer.load + water.suction;  // more is air, which a load has to press out again
      effective = effective > Real(0) ? (effective < most ? effective : most) : Real(0);
      take_in(p, at.normal, answer);
    }
    points.effective_stress[p] = effective;
    if (effective < Real(0)) return;
    Real strength = water.strength(answer.load, effective);
    if (strength > Real(0) && water.critical > Real(0) && water.friction > Real(0)) {
      const Real factor = Real(1) + points.water_strength[p] / water.friction;  // its dilatancy stood there
      strength = factor > Real(0) ? strength * factor : Real(0);
    }
    points.water_strength[p] = strength;
  }

 private:
  /// The answers of the cells at the point, `offset` over its node [layers]. The load goes on the line to the next
  /// cell. What changes goes along the mean of the slopes to the cells above and below (Fromm 1968), about the middle
  /// of what is in the cell: its mean stays. No limit: what it cut off would stay with the points for good.
  TALUS_HD CellAnswer<Real> gather(const CellsAround<Real, Shape>& at, Real offset) const {
    CellAnswer<Real> sum;
    Real weights = 0;
    for (int q = 0; q < Shape::width * Shape::width; ++q) {
      const BlockSlot& stored = at.slot(grid, q);
      const int n = at.column(grid, q) + at.k * block_columns;
      const CellAnswer<Real> own(answers[n]);
      if (!(own.load > Real(0))) continue;
      CellAnswer<Real> up, down;
      if (at.k + 1 < stored.first_layer + stored.layers) up = CellAnswer<Real>(answers[n + block_columns]);
      if (at.k > stored.first_layer) down = CellAnswer<Real>(answers[n - block_columns]);
      const Step to_up(own, up, up.middle + Real(1) - own.middle),
          from_down(down, own, own.middle + Real(1) - down.middle);
      const bool on_down = from_down.known && (offset < own.middle || !to_up.known);
      const Real along = offset - own.middle, weight = at.weight(q);
      const Real half = from_down.known && to_up.known ? Real(0.5) * along : Real(0);
      sum.load += weight * (own.load + along * (on_down ? from_down.load : to_up.load));
      sum.change += weight * (own.change + half * (from_down.change + to_up.change));
      sum.inflow += weight * (own.inflow + half * (from_down.inflow + to_up.inflow));
      weights += weight;
    }
    if (!(weights > Real(0))) return sum;
    const Real over = Real(1) / weights;
    sum.load *= over;
    sum.change *= over;
    sum.inflow *= over;
    return sum;
  }
  /// The slopes from a cell to the one above it, over a distance [layers]; 0 where one of them is empty.
  struct Step {
    bool known;
    Real load = 0, change = 0, inflow = 0;
    TALUS_HD Step(const CellAnswer<Real>& low, const CellAnswer<Real>& high, Real apart)
        : known(low.load > Real(0) && high.load > Real(0) && apart > Real(0.25)) {
      if (!known) return;
      load = (high.load - low.load) / apart;
      change = (high.change - low.change) / apart;
      inflow = (high.inflow - low.inflow) / apart;
    }
  };

  /// The effective stress at the start under a load [Pa].
  TALUS_HD Real first(int p, const CellsAround<Real, Shape>& at, Real load) const {
    const Real pull = -dot(this->gravity.at(*clock), at.normal);
    const Real deep = pull > Real(0) ? load / (density * pull) : Real(0);
    const Real dry = static_cast<Real>(table[grid.column(points.cell[0][p], points.cell[1][p])]);
    if (deep < dry) return Real(no_water);
    const Real pressure = ratio < Real(0) ? water.fluid_density * pull * (deep - dry) : ratio * load;
    return pressure < load ? load - pressure : Real(0);
  }

  /// The method lets the point take what water brings, in steps of a flow no more at a time than raises its stress by
  /// the load: what lies thin drains at once, and the stiffness of an undrained mass would throw it.
  TALUS_HD void take_in(int p, const Vec3<Real>& normal, const CellAnswer<Real>& answer) const {
    const Real strain = answer.inflow;
    if (!at_once) {
      const Real most = answer.load / stiffness, taken = points.water_inflow[p] * Real(clock->water.passed),
                 due = points.water_due[p] - taken + strain, interval = Real(clock->water.interval);
      const Real now = due < -most ? -most : due > most ? most : due;
      points.water_inflow[p] = interval > Real(0) ? now / interval : Real(0);
      points.water_due[p] = due;
      return;
    }
    MaterialState<Real> state{points.elastic_of(p), points.log_volume[p], points.plastic_log_volume[p]};
    take_water(state, normal, strain);
    points.set_elastic(p, state.elastic);
    points.plastic_log_volume[p] = state.plastic_log_volume;
  }
};

/// How the water stands at the start of a run.
struct FirstWater {
  std::vector<float> table;  ///< depth of the water table, normal to the bed, [rows * columns] [m]
  double ratio = -1;         ///< of the pressure to the load; negative: hydrostatic
  double density = 0;        ///< of the mass [kg/m3]
  double stiffness = 1;      ///< of the stiffest material across the bed, undrained [Pa]
};

/// The water of a run on a device; nothing where there is none.
template <class Real, class Device, class Shape>
class WaterColumns {
 public:
  /// The constructor takes the water, how it stands at the start, and whether steps take what it brings `at_once`.
  WaterColumns(const Device& device, const std::optional<PoreWater<double>>& water, const FirstWater& first,
               bool at_once)
      : device_(device),
        first_{{}, first.ratio, first.density, first.stiffness},
        cells_(device),
        answers_(device),
        moments_(device),
        weights_(device),
        table_(device),
        at_once_(at_once) {
    if (!water) return;
    on_ = true;
    water_ = water->as<Real>();
    table_.upload(first.table);
    weights_.resize_zeroed(first.table.size());
  }
  bool on() const { return on_; }  ///< whether there is water
  std::size_t bytes() const { return bytes_of(cells_, moments_, answers_, weights_, table_); }

  /// The method gives storage to the cells of so many nodes.
  void resize(std::size_t nodes) {
    if (!on_) return;
    cells_.resize_zeroed(nodes);
    moments_.resize_zeroed(nodes);
    answers_.resize_zeroed(nodes);
  }

  /// What flows ask for besides the points: the clock, gravity, loads (null: none), mass and momentum of the nodes
  /// (null: the slip is not known), and still water.
  struct Around {
    Clock* clock;
    Gravity<Real> gravity;
    const Vec3<double>* loads;
    const Vec4<Real>* nodes;
    Submersion<Real> submersion;
    MapView maps;
  };

  /// The method lets water flow where the clock says so.
  template <class Grid>
  void flow(const ParticleView<Real>& points, const Materials<Real>& materials, Grid& grid, const Around& around) {
    if (!on_) return;
    const ProfilePhase<Device> phase(device_, "water");
    const WaterStep<Real> step{grid.view(),       points, around.clock, around.gravity, around.loads,
                               around.submersion, water_};
    const int columns = grid.active_blocks() * block_columns;
    scatter_points(device_, points.count, grid.groups(),
                   WaterToCells<Real, Shape>{step, materials, cells_.data(), moments_.data()});
    for_each(device_, columns, WeighColumns<Real>{step, grid.active_list(), cells_.data(), weights_.data()});
    for_each(device_, columns,
             FlowAlongColumns<Real>{step, grid.active_list(), static_cast<Real>(first_.density), cells_.data(),
                                    moments_.data(), answers_.data(), around.nodes, weights_.data(), around.maps});
    for_each(
        device_, points.count,
        WaterToPoints<Real, Shape>{step, answers_.data(), table_.data(), static_cast<Real>(first_.ratio),
                                   static_cast<Real>(first_.density), static_cast<Real>(first_.stiffness), at_once_});
  }

 private:
  Device device_;
  bool on_ = false;
  PoreWater<Real> water_;
  FirstWater first_;  ///< its table is on the device
  Buffer<Vec4<Real>, Device> cells_, answers_;
  Buffer<Real, Device> moments_, weights_;
  Buffer<float, Device> table_;
  bool at_once_;
};

}  // namespace talus
