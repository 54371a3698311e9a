// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From points to the cells of the columns: weight, effective stress and volume change (T50).
#pragma once

#include "solver/boundary/submersion.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/tiles.hpp"
#include "solver/state/clock.hpp"
#include "solver/transfer/stencil.hpp"
#include "solver/water/pore_water.hpp"

namespace talus {

/// What a step with water knows of points and grid.
template <class Real>
struct WaterStep {
  GridView<Real> grid;
  ParticleView<Real> points;
  Clock* clock;  ///< says whether the step has to do with water at all
  Gravity<Real> gravity;
  const Vec3<double>* loads;  ///< force per volume of each load [N/m3]; null without loads
  Submersion<Real> submersion;
  PoreWater<Real> water;

  /// The share of point p that lies below the level of still water [-].
  template <class Cells>
  TALUS_HD Real below(const Cells& at, int p) const {
    if (!submersion.on()) return Real(0);
    Real ground = 0;
    for (int q = 0; q < Cells::columns_each; ++q)
      ground += at.weight(q) * grid.terrain[grid.column(at.i + q % Cells::width, at.j + q / Cells::width)];
    return submersion.share(ground + (Real(at.k) + points.offset[2][p]) * grid.layer_height, grid.layer_height);
  }
  TALUS_HD bool is_due() const { return clock->alarms.halt == running && clock->water.is_due != 0; }
};

/// The weights of a point on the columns around it, and its cell in them: the layer of its nearest node.
template <class Real, class Shape>
struct CellsAround {
  static constexpr int width = Shape::width, columns_each = width * width;
  int i, j, k;
  Real x[Shape::width], y[Shape::width];
  Vec3<Real> normal;  ///< of the ground under it
  TALUS_HD CellsAround(const GridView<Real>& grid, const ParticleView<Real>& points, int p)
      : CellsAround(Stencil<Real, Shape>(grid, points, p), points.cell[2][p]) {}
  TALUS_HD Real weight(int q) const { return x[q % Shape::width] * y[q / Shape::width]; }
  /// Where the block of column q is stored.
  TALUS_HD const BlockSlot& slot(const GridView<Real>& grid, int q) const {
    return grid.slot(i + q % Shape::width, j + q / Shape::width);
  }
  /// The place of layer 0 of column q in storage.
  TALUS_HD int column(const GridView<Real>& grid, int q) const {
    return Stencil<Real, Shape>::column_at(grid, i + q % Shape::width, j + q / Shape::width);
  }

 private:
  TALUS_HD CellsAround(const Stencil<Real, Shape>& s, int layer)
      : i(s.i), j(s.j), k(layer), normal(normal_of(s.slope_x, s.slope_y)) {
    for (int a = 0; a < Shape::width; ++a) {
      x[a] = s.wx[a];
      y[a] = s.wy[a];
    }
  }
};

/// The scatter of the points' weight across the bed [N], its moment about the cell's node [N layers] and, of those with
/// water, volume [m3], effective stress [Pa m3] and volume change [m3] to the cells of the columns. See ScatterKernel
/// (tiles.hpp) for its members. Before, shear changes the effective stress (T50e).
template <class Real, class Shape>
struct WaterToCells : WaterStep<Real> {
  using Base = WaterStep<Real>;
  using Base::grid, Base::points;
  using Number = Real;
  static constexpr int width = Shape::width, columns_each = width * width, deep = 1, parts = 5;
  Materials<Real> materials;
  Vec4<Real>* cells;
  Real* moments;

  struct Source {
    CellsAround<Real, Shape> at;
    int i, j, k;
    Real weight, moment, volume = 0, effective = 0, change = 0;

    TALUS_HD Source(const WaterToCells& kernel, int p) : at(kernel.grid, kernel.points, p), i(at.i), j(at.j), k(at.k) {
      const ParticleView<Real>& all = kernel.points;
      const Real own = all.volume[p];
      Vec3<Real> pull = kernel.gravity.at(*kernel.clock) * (own * kernel.materials.density(all.material, p) *
                                                            kernel.submersion.weight(kernel.below(at, p)));
      if (kernel.loads && all.load[p] >= 0) pull += narrow<Real>(kernel.loads[all.load[p]]) * own;
      weight = -dot(pull, at.normal);
      moment = weight * all.offset[2][p];
      const Real before = all.effective_stress[p];
      if (before < Real(0)) return;
      volume = own;
      change = all.plastic_log_volume[p];
      effective = before;
      if (!(kernel.water.critical > Real(0))) return;
      effective = kernel.shear(p, before, kernel.water.solid_at(change));
    }
  };
  struct Sums {
    Real weight = 0, moment = 0;
    Vec3<Real> wet{};
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }  ///< one thread: one point
  TALUS_HD bool counts(int p) const { return this->is_due() && points.cell[0][p] >= 0; }
  TALUS_HD static const Source& nodes_of(const Source& s) { return s; }
  TALUS_HD int column_of(const Source& s, int q) const { return s.at.column(grid, q); }
  TALUS_HD static int node_in(int column, int k, int) { return column + k * block_columns; }
  TALUS_HD static bool owns(int, int) { return true; }
  TALUS_HD void add(const Source& s, int q, Sums (&sums)[deep]) const {
    const Real share = s.at.weight(q);
    sums[0].weight += share * s.weight;
    sums[0].moment += share * s.moment;
    sums[0].wet += Vec3<Real>{s.volume, s.volume * s.effective, s.volume * s.change} * share;
  }
  TALUS_HD void add_to_node(int n, const Sums& sums) const {
    scatter_add(&cells[n], Four<Real>(sums.weight, sums.wet));
    scatter_add(&moments[n], sums.moment);
  }
  TALUS_HD static void store(const Sums& sums, Real* to) {
    to[0] = sums.weight;
    to[1] = sums.wet.x;
    to[2] = sums.wet.y;
    to[3] = sums.wet.z;
    to[4] = sums.moment;
  }
  TALUS_HD Real* part(int n, int q) const { return q < 4 ? &cells[n].w + q : &moments[n]; }

  /// The method stores and returns the effective stress of point p after its shear since the last step with water, and
  /// keeps the dilatancy where the strength will stand [Pa].
  TALUS_HD Real shear(int p, Real effective, Real solid) const {
    const Real passed = Real(this->clock->water.passed);
    const Real shear = Real(sqrt(Real(3)) * (points.plastic_shear[p] - points.shear_seen[p]));  // of simple shear
    points.shear_seen[p] = points.plastic_shear[p];
    points.water_strength[p] = Real(0);
    if (!(passed > Real(0)) || !(shear > Real(0))) return effective;
    const Real rate = shear / passed, after = this->water.sheared(solid, effective, shear, rate);
    points.water_strength[p] = this->water.dilatancy(solid, after, rate).tangent;
    points.effective_stress[p] = after;
    return after;
  }
};

}  // namespace talus
