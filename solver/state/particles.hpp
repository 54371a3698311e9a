// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The material points: arrays of their state, owned (Particles) and as a kernel sees them (ParticleView).
#pragma once

#include <cstdint>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/math.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particle_fields.hpp"

namespace talus {

/// The fields of particle_fields.hpp as a kernel sees them: a pointer for each component, null where the run does not
/// need the field.
template <class Real>
struct ParticleView {
  using Ints = int*;
  using Reals = Real*;
  int count = 0;
  TALUS_DECLARE_PARTICLE_FIELDS

  static constexpr double place_bytes = 3 * (sizeof(int) + sizeof(Real));  ///< of a position

  /// The velocity of point p [m/s].
  TALUS_HD Vec3<Real> velocity_of(int p) const { return {velocity[0][p], velocity[1][p], velocity[2][p]}; }
  /// The elastic state of point p, as its material keeps it [-].
  TALUS_HD Sym3<Real> elastic_of(int p) const {
    return {elastic[0][p], elastic[1][p], elastic[2][p], elastic[3][p], elastic[4][p], elastic[5][p]};
  }
  /// The method stores the elastic state of point p.
  TALUS_HD void set_elastic(int p, const Sym3<Real>& s) const {
    elastic[0][p] = s.xx;
    elastic[1][p] = s.yy;
    elastic[2][p] = s.zz;
    elastic[3][p] = s.xy;
    elastic[4][p] = s.yz;
    elastic[5][p] = s.xz;
  }

  /// The affine velocity of point p per cell, C_p of (T8) in columns x, y, zeta [m/s].
  TALUS_HD Mat3<Real> affine_of(int p) const {
    return {{affine[0][p], affine[1][p], affine[2][p]},
            {affine[3][p], affine[4][p], affine[5][p]},
            {affine[6][p], affine[7][p], affine[8][p]}};
  }
  /// The method stores the affine velocity of point p.
  template <class Number>
  TALUS_HD void set_affine(int p, const Mat3<Number>& m) const {
    const Number values[9] = {m.a.x, m.a.y, m.a.z, m.b.x, m.b.y, m.b.z, m.c.x, m.c.y, m.c.z};
    for (int q = 0; q < 9; ++q) affine[q][p] = static_cast<Real>(values[q]);
  }

  /// Half the side of a point's box along an axis as weights use it [cells]: at least `least`, at most half a cell.
  TALUS_HD Real half_extent(int p, int axis, Real least) const {
    const Real half = Real(0.5) * extent[axis][p];
    return half < Real(0.5) ? (half > least ? half : least) : Real(0.5);
  }
  /// The method stretches the box (T2a) after a step with displacement gradient g over ground of these slopes: its
  /// sides grow with what happens along them.
  TALUS_HD void stretch_box(int p, const Mat3<Real>& g, Real slope_x, Real slope_y) const {
    const Real rise = slope_x * g.c.x + slope_y * g.c.y;
    extent[0][p] *= Real(1) + g.a.x + slope_x * g.c.x;
    extent[1][p] *= Real(1) + g.b.y + slope_y * g.c.y;
    extent[2][p] *= Real(1) + g.c.z - rise;
  }

  /// The method moves point p by `way` [cells] to its new cell and offset: nothing goes below the ground or behind a
  /// wall.
  template <class Move>
  TALUS_HD void move_by(int p, const Vec3<Move>& way, const WallNodes& walls) const {
    shift(cell[0][p], offset[0][p], way.x, walls.west, walls.east);
    shift(cell[1][p], offset[1][p], way.y, walls.south, walls.north);
    shift(cell[2][p], offset[2][p], way.z, 0, WallNodes::far);
  }

 private:
  template <class Move>
  TALUS_HD static void shift(int& cell, Real& offset, Move move, int first, int last) {
    const Move to = static_cast<Move>(offset) + move;
    const Move whole = Move(floor(to + Move(0.5)));
    offset = static_cast<Real>(to);
    if (!(fabs(whole) < Move(1000000))) return;  // lost: the step's settle() reports the point
    offset = static_cast<Real>(to - whole);
    cell += static_cast<int>(whole);
    if (cell < first || (cell == first && offset < Real(0))) {
      cell = first;
      offset = Real(0);
    } else if (cell > last || (cell == last && offset > Real(0))) {
      cell = last;
      offset = Real(0);
    }
  }
};

/// A copy of the points on the host, in double; lists of one length, or empty where they were not asked for.
struct ParticleState {
  using Ints = std::vector<int>;
  using Reals = std::vector<double>;
  TALUS_DECLARE_PARTICLE_FIELDS

  /// The number of points.
  std::size_t size() const { return id.size(); }
  /// The method makes room for `count` points at their initial values.
  void resize(std::size_t count);
};

/// The owner of the points' arrays on a device.
template <class Real, class Device>
class Particles {
 public:
  Particles(const Device& device, ParticleNeeds needs);

  /// The method takes the lists of the fields that are needed; those kept within a step alone get memory.
  void upload(const ParticleState& state);
  /// The method adds points behind those that are there.
  void append(const ParticleState& more);
  /// The fields that are kept at least so long, in double; those that are not needed have their initial value.
  ParticleState download(Kept least = Kept::in_checkpoint) const;
  /// The points as kernels see them, until the next upload() or reorder().
  ParticleView<Real> view();
  /// The number of points.
  int count() const { return count_; }
  /// The memory taken [bytes].
  std::size_t bytes() const;
  /// The initial volumes of the points [m3], on the device.
  const Buffer<Real, Device>& volume() const { return arrays_.volume; }

  /// The method puts the points in a new order: point order[p] becomes point p; only the first `count` are kept.
  void reorder(const Buffer<int, Device>& order, int count);

 private:
  struct Arrays {
    using Ints = Buffer<int, Device>;
    using Reals = Buffer<Real, Device>;
    TALUS_DECLARE_PARTICLE_FIELDS
  };

  bool holds(const ParticleField& field) const { return needs_.*field.needed_by; }
  bool sorts(const ParticleField& field) const { return holds(field) && field.kept != Kept::within_step; }
  void reorder_together(const Buffer<int, Device>& order, int count);
  Device device_;
  ParticleNeeds needs_;
  int count_ = 0;
  Arrays arrays_, twins_;  ///< the second set of as many points as may be kept twice
  Buffer<Real, Device> real_scratch_;
  Buffer<int, Device> int_scratch_;
};

}  // namespace talus
