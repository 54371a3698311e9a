// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grid to particle (G2P): velocity, its gradient, the move and the new stress of the points; how much of it a point
// keeps that is alone in column-implicit steps (T6d).
#pragma once

#include "solver/material/material.hpp"
#include "solver/state/clock.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus {

/// How the mass on the columns around a point lies to it.
template <class Real>
struct Company {
  Real all = 0, as_x = 0, as_y = 0;  ///< mass, and mass by the point's weights [kg]

  /// The method takes the mass of a column at the point's height [kg], and the column's weights.
  TALUS_HD void add(Real mass, Real wx, Real wy) {
    all += mass;
    as_x += mass * wx;
    as_y += mass * wy;
  }

  /// 0: mass is even around the point, in x or y at least; 1: it is spread as the point's own weights, for there is no
  /// other matter beside it. What touches a wall is never alone. Only splines can tell.
  template <class Shape>
  TALUS_HD Real alone(const Stencil<Real, Shape>& s) const {
    if (Shape::width != 3 || s.edge_x || s.edge_y || !(all > Real(0))) return Real(0);
    const Real x = share(as_x / all, s.wx), y = share(as_y / all, s.wy);
    return x < y ? x : y;
  }

 private:
  TALUS_HD static Real share(Real spread, const Real* w) {
    const Real even = Real(1.0 / 3), own = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    return (spread - even) / (own - even);
  }
};

/// The share of its stress that a point keeps in a step in which waves cross `crossed` of a cell (T6d): below 1 from
/// 3/4 alone on, in steps beyond 0.5 CFL. A lone point has (omega dt)^2 <= 32 crossed^2, on slopes up to 45 degrees in
/// layers down to a sixteenth of a cell and up to 60 degrees in layers down to a quarter, and one that keeps a share s
/// of its stress is stable up to 2 + 2 / s.
template <class Real>
TALUS_HD Real share_kept_alone(Real alone, Real crossed) {
  const Real lonely = alone > Real(0.95) ? Real(1) : Real(5) * (alone - Real(0.75));
  const Real square = Real(32) * crossed * crossed * lonely;
  return square > Real(4) ? Real(2) / (square - Real(2)) : Real(1);
}

/// Which part of the gather a kernel does.
enum class Gather {
  all,         ///< USL: everything at once
  motion,      ///< MUSL, first half: velocity and displacement, kept in points.move
  deformation  ///< MUSL, second half: gradient from the remapped momentum, stress, and the kept displacement
};

/// The gather of velocity (T7, T8), velocity gradient (T9) and way (T10) of the points. One thread: one point. nodes[]
/// holds mass and new velocity; changes[] the velocity change of the step, null where points keep nothing of their own
/// velocity. `budget`: adds up what is lost (T24), for the clock. `by_layers`: waves across the layers bound the step,
/// as they do where columns are not implicit.
template <class Real, class Shape, Gather part, bool budget, bool by_layers = true, class Laws = MaterialLaws>
struct GridToParticle {
  /// See for_each(). Splines would spill registers where one block more shares a multiprocessor.
  static constexpr int dense =
      part == Gather::all && !budget ? (sizeof(Real) == 8 ? 4 : 6) - (Shape::width == 3 ? 1 : 0) : 1;
  static constexpr bool hot = part == Gather::all && !budget;  ///< see run_range()
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real, Laws> materials;
  Clock* clock;
  const Vec4<Real>* nodes;
  const Vec4<Real>* changes;
  const std::uint64_t* home;  ///< key of the cell the point was sorted by (see home_key())
  bool affine;
  bool dilatant;

  /// The memory that the kernel moves for that many points [bytes].
  double bytes(int count) const {
    const int moved = part == Gather::deformation ? 0 : 3 + (affine ? 9 : 0),
              deformed = part == Gather::motion ? 0 : 2 * (dilatant ? 8 : 7);
    return count * (2 * points.place_bytes + (moved + deformed) * static_cast<double>(sizeof(Real)) + sizeof(*home)) +
           grid.nodes * static_cast<double>((changes ? 2 : 1) * sizeof(*nodes));
  }

  /// The sums over a point's nodes.
  struct Sums {
    Vec3<Real> velocity;    ///< [m/s]
    Mat3<Real> gradient;    ///< by reference coordinates, per cell
    Real climb = 0;         ///< rate of zeta [m/s]
    Vec3<Real> bend;        ///< gradient of the ground's slopes: xx, yy, twice xy, per cell
    Mat3<Real> moment;      ///< of velocity about the point, in cells
    Vec3<Real> change;      ///< of the velocity in the step, where points keep some of their own [m/s]
    Company<Real> company;  ///< of other matter around the point, where columns are implicit
  };

  TALUS_HD void operator()(int p) const {
    if (clock->alarms.halt != running || points.cell[0][p] < 0) return;
    prefetch(p);
    const Stencil<Real, Shape> s(grid, points, p);
    const Sums sums = gather(s);
    const Real dt = Real(clock->step_size);
    if constexpr (part != Gather::deformation) move_with(p, s, sums, dt);
    if constexpr (part != Gather::motion) {
      const Real waves = deform(p, s, sums, dt);
      settle(p, s, sums, waves);
    }
  }

 private:
  /// The method asks for what of point p is needed once its nodes are read, whose sums leave no registers for it: a
  /// wait for memory less.
  TALUS_HD void prefetch(int p) const {
    for (int q = 0; q < 3; ++q) talus::prefetch(points.velocity[q] + p);
    if constexpr (part != Gather::motion) {
      for (int q = 0; q < 6; ++q) talus::prefetch(points.elastic[q] + p);
      talus::prefetch(points.log_volume + p);
      talus::prefetch(points.volume + p);
      talus::prefetch(home + p);
    }
  }

  /// What a node with slopes nx, ny adds to Sums::bend, by the gradient of its weight.
  TALUS_HD static Vec3<Real> bend_of(Real nx, Real ny, Real across, Real along) {
    return {nx * across, ny * along, ny * across + nx * along};
  }

  TALUS_HD Sums gather(const Stencil<Real, Shape>& s) const {
    // A CPU tests flags at each of the nodes; the usual ones have a copy of the loop without.
    if constexpr (TALUS_ON_CPU == 1) {
      if (affine && changes && grid.mapping == Mapping::terrain_following) return sum_up<true>(s);
    }
    return sum_up<false>(s);
  }

  template <bool usual>
  TALUS_HD Sums sum_up(const Stencil<Real, Shape>& s) const {
    Sums sums;
    Four<Real> velocity, change, by_x, by_y, by_z, lever_x, lever_y, lever_z;
    const bool follows = usual || grid.mapping == Mapping::terrain_following, with_affine = usual || affine,
               has_changes = usual || changes;
    TALUS_UNROLL  // weights looked up by a loop's counter would go through memory
        for (int b = 0; b < Shape::width; ++b) {
      TALUS_UNROLL
      for (int a = 0; a < Shape::width; ++a) {
        const int i = s.i + a, j = s.j + b, column = s.column(grid, a, b);
        const Real nx = follows ? grid.slope_x[grid.column(i, j)] : Real(0),
                   ny = follows ? grid.slope_y[grid.column(i, j)] : Real(0);
        Four<Real> mean, rise, lever, changed;  // of the column, weighed once
        TALUS_UNROLL
        for (int c = 0; c < Shape::width; ++c) {
          const int n = s.node(column, c);
          const Four<Real> node(nodes[n]);
          mean += node * s.wz[c];
          rise += node * s.gz[c];
          if (with_affine) lever += node * (s.wz[c] * (s.near_z + Real(c)));
          if (has_changes) changed += Four<Real>(changes[n]) * s.wz[c];
        }
        const Real w = s.wx[a] * s.wy[b];
        const Vec3<Real> v = mean.xyz();
        if constexpr (!by_layers) sums.company.add(mean.w(), s.wx[a], s.wy[b]);
        velocity += mean * w;
        change += changed * w;
        sums.climb += (v.z - nx * v.x - ny * v.y) * w;
        if (follows) sums.bend += bend_of(nx, ny, s.gx[a] * s.wy[b], s.wx[a] * s.gy[b]);
        by_x += mean * (s.gx[a] * s.wy[b]);
        by_y += mean * (s.wx[a] * s.gy[b]);
        by_z += rise * w;
        if (with_affine) {
          lever_x += mean * (w * (s.near_x + Real(a)));
          lever_y += mean * (w * (s.near_y + Real(b)));
          lever_z += lever * w;
        }
      }
    }
    sums.velocity = velocity.xyz();
    sums.change = change.xyz();
    sums.gradient = {by_x.xyz(), by_y.xyz(), by_z.xyz()};
    sums.moment = {lever_x.xyz(), lever_y.xyz(), lever_z.xyz()};
    return sums;
  }

  TALUS_HD void move_with(int p, const Stencil<Real, Shape>& s, const Sums& sums, Real dt) const {
    Vec3<Real> v = sums.velocity;
    const Real kept = changes ? Real(clock->subgrid.kept) : Real(0);
    const Real rise = sums.climb - climb_ahead(sums, dt);
    Real asked = 0;
    if (kept > Real(0)) {
      const Vec3<Real> finer = points.velocity_of(p) + sums.change - v;
      asked = part_up_to(finer.z, asked_by_ground(s, sums, rise));
      v += finer * kept;
      v.z += asked * (Real(1) - kept);
    }
    if constexpr (budget) {
      const Vec3<Real> old = points.velocity_of(p);
      const double mass = static_cast<double>(points.volume[p] * materials.density(points.material, p));
      atomic_add(&clock->budget.transfer_loss,
                 0.5 * mass * (static_cast<double>(dot(old, old)) - static_cast<double>(dot(v, v))));
      atomic_add(&clock->budget.reaction[2], mass * static_cast<double>(asked * (Real(1) - kept)));
    }
    points.set_velocity(p, v);
    if (affine) points.set_affine(p, s.affine_velocity(sums.moment, sums.gradient));
    const Vec3<Real> move{sums.velocity.x * dt / grid.spacing, sums.velocity.y * dt / grid.spacing,
                          rise * dt / grid.layer_height};
    if constexpr (part == Gather::motion) {
      points.move[0][p] = move.x;
      points.move[1][p] = move.y;
      points.move[2][p] = move.z;
    } else {
      points.move_by(p, move, grid.walls);
    }
  }

  /// What the ground asks of a point over its nodes, where they leave it or come down at less than that (T8b) [m/s].
  TALUS_HD static Real asked_by_ground(const Stencil<Real, Shape>& s, const Sums& sums, Real rise) {
    const Real asked = s.slope_x * sums.velocity.x + s.slope_y * sums.velocity.y - (sums.velocity.z - sums.climb);
    return fabs(rise) < fabs(asked) ? asked : Real(0);
  }

  /// The part of a value that lies between zero and an end.
  TALUS_HD static Real part_up_to(Real value, Real end) {
    const Real least = end < Real(0) ? end : Real(0), most = end > Real(0) ? end : Real(0);
    return value < least ? least : value > most ? most : value;
  }

  /// What the ground climbs before the point in half a step over what the slopes under it give (T12d) [m/s].
  TALUS_HD Real climb_ahead(const Sums& sums, Real dt) const {
    const Vec3<Real>& v = sums.velocity;
    return dt / (Real(2) * grid.spacing) *
           (v.x * v.x * sums.bend.x + v.y * v.y * sums.bend.y + v.x * v.y * sums.bend.z);
  }

  /// The method gives the point its new state; it returns the speed of waves in it [m/s].
  TALUS_HD Real deform(int p, const Stencil<Real, Shape>& s, const Sums& sums, Real dt) const {
    const Real across = dt / grid.spacing, up = dt / grid.layer_height;
    const Vec3<Real> c = sums.gradient.c * up;
    const Mat3<Real> g{sums.gradient.a * across - c * s.slope_x, sums.gradient.b * across - c * s.slope_y, c};
    MaterialState<Real> state{points.elastic_of(p), points.log_volume[p],
                              dilatant ? points.plastic_log_volume[p] : Real(0)};
    const Material<Real, Laws> material = materials.of(points, p);
    if (points.water_inflow) take_water(state, normal_of(s.slope_x, s.slope_y), points.water_inflow[p] * dt);
    const MaterialState<Real> before = state;
    const int pieces = pieces_of(g);
    if (pieces == 1)
      advance_material(material, g, dt, state);
    else
      state = advance_in_pieces(material, g, pieces, dt, state);
    const Real waves = wave_speed(material, state);
    if constexpr (!by_layers) {
      const Real kept = material.holds_tension() ? Real(1) : share_kept_alone(sums.company.alone(s), waves * across);
      if (kept < Real(1)) forget_stress(material, kept, state);
    }
    if constexpr (budget) lose_to_flow(material, before, state, g, points.volume[p]);
    if (points.plastic_shear) points.plastic_shear[p] += state.plastic_shear;
    points.set_elastic(p, state.elastic);
    points.log_volume[p] = state.log_volume;
    if (dilatant) points.plastic_log_volume[p] = state.plastic_log_volume;
    if constexpr (Shape::averaged) points.stretch_box(p, g, s.slope_x, s.slope_y);
    if (points.piece) points.stretch_sides(p, g);
    if constexpr (part == Gather::deformation) {
      points.move_by(p, Vec3<Real>{points.move[0][p], points.move[1][p], points.move[2][p]}, grid.walls);
    }
    return waves;
  }

  /// The work of the stress, less what is kept as elastic energy.
  TALUS_HD void lose_to_flow(const Material<Real, Laws>& m, const MaterialState<Real>& before,
                             const MaterialState<Real>& after, const Mat3<Real>& g, Real volume) const {
    const Sym3<Real> tau = (kirchhoff_stress(m, before) + kirchhoff_stress(m, after)) * Real(0.5);
    const Real work = tau.xx * g.a.x + tau.yy * g.b.y + tau.zz * g.c.z + tau.xy * (g.a.y + g.b.x) +
                      tau.yz * (g.b.z + g.c.y) + tau.xz * (g.a.z + g.c.x);
    const Real kept = elastic_energy(m, after) - elastic_energy(m, before);
    atomic_add(&clock->budget.plastic_loss, static_cast<double>(volume) * static_cast<double>(work - kept));
  }

  /// The method raises the alarms of the clock: not a number, left the domain, left the home cell's neighbourhood; and
  /// it measures the step size of the next step, the bracket of (T11).
  TALUS_HD void settle(int p, const Stencil<Real, Shape>& s, const Sums& sums, Real wave_speed) const {
    const Vec3<Real> v = points.velocity_of(p);
    const Real speed = length(v);
    // A point that crossed a cell in one step, or whose state is no number, has left the equations.
    if (!(speed < Real(1e6)) || !(fabs(points.log_volume[p]) < Real(1e3)) || !(fabs(points.offset[2][p]) <= Real(1))) {
      raise_flag(&clock->alarms.failed_point, points.id[p]);
      raise_flag(&clock->alarms.request, failed);
      return;
    }
    const int i = points.cell[0][p], j = points.cell[1][p], k = points.cell[2][p];
    if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows || !grid.open[grid.column(i, j)]) {
      points.cell[0][p] = -1;
      atomic_add(&clock->outflow.volume, static_cast<double>(points.volume[p]));
      atomic_increment(&clock->outflow.count);
      return;  // it takes no part in the next steps, and is dropped at the next sort
    }
    const Real steep = Real(1) + s.slope_x * s.slope_x + s.slope_y * s.slope_y;
    const Real hx = Real(1) / grid.spacing, hz = Real(1) / grid.layer_height;
    const Real waves = Real(wave_speed * sqrt(Real(2) * hx * hx + (by_layers ? steep * hz * hz : Real(0))));
    const Real flow = Real(fabs(v.x) * hx + fabs(v.y) * hx + fabs(sums.climb) * hz);
    atomic_max_positive(&clock->control.rate_bits, static_cast<float>(waves + flow));
    atomic_max_positive(&clock->control.speed_bits, static_cast<float>(speed));
    const HomeCell at(grid.block_columns_x, home[p]);
    const int below = grid.homes_below ? 1 : 0;  // storage goes by where a point was, a cell above its home at most
    const auto beyond = [&](int way, int most) { return way > most || way < below - most; };
    const bool high = beyond(k - at.k, grid.climb);
    if (high || beyond(i - at.i, grid.drift) || beyond(j - at.j, grid.drift))
      replace_if(&clock->alarms.request, running, high ? climbed : wants_sort);
  }
};

}  // namespace talus
