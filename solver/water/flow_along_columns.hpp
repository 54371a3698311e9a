// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The flow of water along the columns of the grid, from cell to cell (T50a), and what it leaves at the bed.
#pragma once

#include "solver/boundary/column_flow.hpp"
#include "solver/state/map_view.hpp"
#include "solver/water/water_to_cells.hpp"

namespace talus {

/// A cell of a column as the points have filled it.
template <class Real>
struct WaterCell {
  Real weight = 0;     ///< across the bed, dry points too [N]
  Real depth = 0;      ///< of what has water, normal to the bed [m]
  Real effective = 0;  ///< stress [Pa]
  Real by_shear = 0;   ///< of that, what the slip over the bed has changed [Pa]
  Real solid = 0;      ///< solid fraction [-]
  Real stiffness = 1;  ///< of the skeleton [Pa]
  Real mobility = 0;   ///< k / mu_f [m2/(Pa s)]
  TALUS_HD bool wet() const { return depth > Real(0); }

  WaterCell() = default;
  /// Of the sums that points left.
  TALUS_HD WaterCell(const PoreWater<Real>& water, const Vec4<Real>& sums, Real area) : weight(sums.w) {
    if (!(sums.x > Real(0))) return;
    depth = sums.x / area;
    effective = sums.y / sums.x;
    solid = water.solid_at(sums.z / sums.x);
  }
  /// As kept() left it, without stiffness and mobility.
  TALUS_HD explicit WaterCell(const Vec4<Real>& kept)
      : weight(kept.w), depth(kept.x), effective(kept.y), solid(kept.z) {}
  TALUS_HD Vec4<Real> kept() const { return {weight, depth, effective, solid}; }
  /// The conductance to the cell above for a step of `duration`, as a depth over a stiffness; 0 where either is dry. On
  /// a `sealed` bed that of the parabola through both cells that is level there: the face is nearer to the lower one.
  TALUS_HD Real to(const WaterCell& above, Real duration, bool sealed) const {
    if (!wet() || !above.wet()) return Real(0);
    Real apart = Real(0.5) * (depth / mobility + above.depth / above.mobility);
    if (sealed) {
      const Real all = depth + above.depth, own = depth * depth / Real(3),
                 next = (all * all * all - depth * depth * depth) / (Real(3) * above.depth);
      apart *= (next - own) / (depth * all);
    }
    return duration / apart;
  }
};

/// What the cells of a column give back to the points.
template <class Real>
struct CellAnswer {
  Real load = 0;    ///< across the bed at its middle [Pa]; 0: no matter
  Real change = 0;  ///< of the effective stress [Pa]
  Real inflow = 0;  ///< strain by water [-]
  Real middle = 0;  ///< height of its middle over its node [layers]
  CellAnswer() = default;
  TALUS_HD explicit CellAnswer(const Vec4<Real>& kept) : load(kept.w), change(kept.x), inflow(kept.y), middle(kept.z) {}
};

/// One thread: one column. It sums the weight of the column's cells [N].
template <class Real>
struct WeighColumns : WaterStep<Real> {
  const int* active;
  const Vec4<Real>* cells;
  Real* weights;  ///< [rows * columns]

  TALUS_HD void operator()(int c) const {
    if (!this->is_due()) return;
    const ColumnNodes at = ColumnNodes::find(this->grid, active, c);
    if (!at.in_domain()) return;
    Real sum = 0;
    for (int k = at.begin(); k < at.end(); ++k) sum += cells[at.node(k)].w;
    weights[at.column] = sum > Real(0) ? sum : Real(0);
  }
};

/// One thread: one column. Excess pressure flows along it by (T50a), backward Euler in time, with cells as deep as what
/// fills them; the sums of the cells are zero again afterwards. What grains bear at the bed goes to the maps.
template <class Real>
struct FlowAlongColumns : WaterStep<Real> {
  using Base = WaterStep<Real>;
  using Base::clock, Base::grid, Base::water;
  const int* active;
  Real density;  ///< of the mass [kg/m3]
  Vec4<Real>* cells;
  Real* moments;            ///< of the cells' weights about their nodes [N layers]
  Vec4<Real>* answers;      ///< CellAnswer of every cell; in between what substitute() needs of eliminate()
  const Vec4<Real>* nodes;  ///< mass and momentum of the step's nodes; null: the bed's slip is not known
  const Real* weights;      ///< of all columns, [rows * columns] [N]
  MapView maps;

  TALUS_HD void operator()(int c) const {
    if (!this->is_due()) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    maps.grains_share[at.column] = 1;
    maps.effective_stress[at.column] = 0;
    if (!(weights[at.column] > Real(0))) return;
    const Column column(*this, at);
    if (!(column.area > Real(0))) return leave_out(at);
    const Top total = eliminate(at, column);
    substitute(at, column, total);
  }

 private:
  struct Column {
    Real area;      ///< of bed that is covered, along the slope [m2]
    Real mass;      ///< weight of what is full of water across the bed [N/m3]
    Real water;     ///< weight of the water across the bed [N/m3]
    Real layer;     ///< height of a layer normal to the bed [m]
    Real duration;  ///< [s]
    Real shear;     ///< its rate by the slip over the bed (T50f) [1/s]
    Real surface;   ///< pressure of the water at its surface (T50i) [Pa]
    TALUS_HD Column(const FlowAlongColumns& k, const ColumnNodes& at) : duration(Real(k.clock->water.duration)) {
      const ColumnBed<Real> bed = bed_under(k.grid, k.weights, at.i, at.j);
      area = bed.area;
      layer = k.grid.layer_height * bed.normal.z;
      const Real pull = -dot(k.gravity.at(*k.clock), bed.normal);
      const Real depth = k.weights[at.column] / (area * (k.density * pull));
      const Real below =
          k.submersion.on() ? k.submersion.share(k.grid.terrain[at.column] + depth, k.grid.layer_height) : Real(0);
      mass = k.density * pull * k.submersion.weight(below);
      water = k.water.fluid_density * pull * (Real(1) - below);  // below the level it is there on all sides
      shear = k.slip(at) / depth;
      surface = k.water.suction > Real(0) ? k.surface_pressure(at, area) * (Real(1) - below) : Real(0);
    }
  };
  /// The method leaves out a column behind a wall, which points before it reach by their shape functions.
  TALUS_HD void leave_out(const ColumnNodes& at) const {
    for (int k = at.begin(); k < at.end(); ++k) {
      cells[at.node(k)] = answers[at.node(k)] = {};
      moments[at.node(k)] = 0;
    }
  }

  /// What lies over a cell.
  struct Top {
    Real weight = 0;  ///< [N]
    Real depth = 0;   ///< of water without a gap [m]
  };

  /// The speed of the mass over the bed [m/s]; 0 where it is not known, or shear changes no volume.
  TALUS_HD Real slip(const ColumnNodes& at) const {
    if (!nodes || !(water.critical > Real(0))) return Real(0);
    const Vec4<Real> node = nodes[at.node(0)];
    return node.w > Real(0) ? length(Vec3<Real>{node.x, node.y, node.z}) / node.w : Real(0);
  }
  /// The pressure at the surface of a column by the water that it has taken in since the start.
  TALUS_HD Real surface_pressure(const ColumnNodes& at, Real area) const {
    Real taken = 0;
    for (int k = at.begin(); k < at.end(); ++k) taken += cells[at.node(k)].z;
    return water.surface_pressure(taken / area);
  }
  /// The load at the middle of what of a cell has water [Pa]: dry points of the cell and loads lie over it.
  TALUS_HD Real load_on(const WaterCell<Real>& own, const Column& column, const Top& top) const {
    const Real held = own.wet() ? own.depth * column.mass : own.weight / column.area;
    return (top.weight + own.weight) / column.area - Real(0.5) * held;
  }
  /// The method returns the height of the middle of what is in a cell over its node [layers], and clears it.
  TALUS_HD Real take_middle(const WaterCell<Real>& own, int n) const {
    const Real moment = moments[n];
    moments[n] = 0;
    return own.weight > Real(0) ? moment / own.weight : Real(0);
  }
  TALUS_HD WaterCell<Real> cell(const ColumnNodes& at, const Column& column, int k) const {
    if (k < at.begin() || k >= at.end()) return {};
    WaterCell<Real> own{water, cells[at.node(k)], column.area};
    if (!own.wet()) return own;
    if (column.shear > Real(0)) {  // without flow (T50e)
      const Real before = own.effective;
      own.effective = water.sheared(own.solid, before, column.shear * column.duration, column.shear);
      own.by_shear = own.effective - before;
    }
    own.stiffness = water.stiffness(own.solid, own.effective);
    own.mobility = water.mobility(own.solid);
    return own;
  }
  /// The pressure in a cell under a load [Pa]; what is sucked beyond `suction` is air.
  TALUS_HD Real pressure_of(const WaterCell<Real>& own, Real load) const {
    const Real pressure = load - own.effective;
    return pressure > -water.suction ? pressure : -water.suction;
  }
  /// The conductance through an open face of a cell; a column of one cell has that of the first mode of diffusion.
  TALUS_HD Real to_face(const WaterCell<Real>& own, const Column& column, bool alone) const {
    constexpr Real one_way = Real(2.4674011), two_ways = Real(4.9348022);  // pi^2 / 4, pi^2 / 2
    return column.duration * own.mobility / own.depth *
           (alone ? (water.drained_bed && !water.sealed_surface ? two_ways : one_way) : Real(2));
  }

  /// The method eliminates from the top. It leaves the cells as kept() gives them and, in their answers, the change of
  /// the effective stress by shear, the pressure at the end without that of the cell below, the share of that in it,
  /// and the pressure at the start.
  TALUS_HD Top eliminate(const ColumnNodes& at, const Column& column) const {
    Top top;
    WaterCell<Real> above, own = cell(at, column, at.end() - 1);
    Real pivot = 1, right = 0;
    Real rest = 0;  // of the pivot without what goes downwards: no differences of large numbers
    for (int k = at.end() - 1; k >= at.begin(); --k) {
      const WaterCell<Real> below = cell(at, column, k - 1);
      if (!own.wet()) top.depth = Real(0);
      if (own.wet()) {
        const Real hydrostatic = column.water * (top.depth + Real(0.5) * own.depth),
                   start = pressure_of(own, load_on(own, column, top)) - hydrostatic, store = own.depth / own.stiffness,
                   up = own.to(above, column.duration, k == 0 && !water.drained_bed),
                   down = below.to(own, column.duration, k == 1 && !water.drained_bed);
        const bool alone = !above.wet() && !below.wet();
        const Real handed = up / pivot;
        const Real surface = above.wet() || water.sealed_surface ? Real(0) : to_face(own, column, alone);
        rest = store + handed * rest + surface;
        if (k == 0 && water.drained_bed) rest += to_face(own, column, alone);
        pivot = rest + down;
        right = store * start + handed * right + surface * column.surface;
        answers[at.node(k)] = {own.by_shear, right / pivot, down / pivot, start};
      }
      cells[at.node(k)] = own.kept();
      top.weight += own.weight;
      top.depth += own.depth;
      above = own;
      own = below;
    }
    return top;
  }

  /// The excess pressures of the three lowest cells of the water that touches the bed.
  struct Foot {
    Real pressure[3] = {}, middle[3] = {};  ///< [Pa], height above the bed [m]
    Real depth = 0;                         ///< of these cells [m]
    Real over = 0;                          ///< hydrostatic pressure at the bed [Pa]
    int count = 0;
    bool ends = false;  ///< what lies above is not of it

    TALUS_HD void add(Real p, Real d) {
      if (ends || count >= 3) return;
      pressure[count] = p;
      middle[count++] = depth + Real(0.5) * d;
      depth += d;
    }
    /// The excess pressure at the bed: on the parabola through the cells, or the line; of a single cell on a cosine
    /// that is level there.
    TALUS_HD Real at_bed() const {
      if (count < 2) return pressure[0] * Real(1.5707963);
      Real sum = 0;
      for (int a = 0; a < count; ++a) {
        Real weight = pressure[a];
        for (int b = 0; b < count; ++b) {
          if (b != a) weight *= middle[b] / (middle[b] - middle[a]);
        }
        sum += weight;
      }
      return sum;
    }
  };

  /// The method goes up with the pressures; `top` is what lies over the bed.
  TALUS_HD void substitute(const ColumnNodes& at, const Column& column, Top top) const {
    const Real load_on_bed = top.weight / column.area;
    Foot foot;
    Real below = 0;  // excess pressure of the cell below [Pa]
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const WaterCell<Real> own(cells[n]);
      cells[n] = {};
      top.weight -= own.weight;
      const Real load = load_on(own, column, top);
      if (!own.wet()) {
        answers[n] = {own.weight > Real(0) ? load : Real(0), Real(0), Real(0), take_middle(own, n)};
        foot.ends = foot.ends || own.weight > Real(0) || foot.count > 0;
        continue;
      }
      const Vec4<Real> kept = answers[n];
      const Real start = kept.z, hydrostatic = pressure_of(own, load) - start, most = load - hydrostatic;
      const Real ended = kept.x + kept.y * below;
      below = ended < most ? ended : most;
      if (foot.count == 0) foot.over = hydrostatic + Real(0.5) * column.water * own.depth;
      foot.add(below, own.depth);
      const Real change = below - start;
      const Real after = own.effective - change, inflow = -water.strain(own.solid, own.effective, after);
      answers[n] = {load, after - own.effective + kept.w, inflow, take_middle(own, n)};
    }
    const Real excess = foot.count == 0 || water.drained_bed ? Real(0) : foot.at_bed();
    const Real borne = foot.count == 0 ? Real(1) : water.strength_share(load_on_bed, load_on_bed - excess - foot.over);
    record(at.column, load_on_bed, borne, excess);
    count(load_on_bed / (column.mass * column.layer), borne);
  }

  /// The method counts a column [layers] for the share that is liquefied. Sums of whole numbers know no order.
  TALUS_HD void count(Real layers, Real borne) const {
    constexpr double parts = 1000, liquefied = 0.1;
    const double depth = floor(static_cast<double>(layers) * parts);
    atomic_add(&clock->water.depths, depth);
    if (static_cast<double>(borne) < liquefied) atomic_add(&clock->water.liquefied, depth);
  }
  /// The method records what water does at the bed of a column, of a load on it and of the excess [Pa].
  TALUS_HD void record(int column, Real load, Real borne, Real excess) const {
    constexpr double noticed = 0.1;
    const double share = static_cast<double>(borne), pressure = 1 - share;
    maps.grains_share[column] = share;
    if (pressure > maps.peak_pore_pressure[column]) maps.peak_pore_pressure[column] = pressure;
    maps.effective_stress[column] = share * static_cast<double>(load);
    if (static_cast<double>(excess) > noticed * static_cast<double>(load)) maps.drained_time[column] = clock->time;
  }
};

}  // namespace talus
