// Kernels of an implicit step: inertia and loads to the grid, stress and tangent of the points for a displacement of
// the grid, the tangent's product with a vector, its diagonal blocks, and the way back to the points.
#pragma once

#include "solver/boundary/walls.hpp"
#include "solver/elements/mean_dilation.hpp"
#include "solver/grid/bicubic.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"
#include "solver/material/tangent.hpp"
#include "solver/state/clock.hpp"
#include "solver/transfer/point_gradients.hpp"

namespace talus::solver {

/// Where a node stands with the surface it can touch (ground or a frictional wall): away from it, slipping along it, or
/// stuck to it.
enum class Touch : unsigned char { none, open, slips, sticks };

/// Arrays over the stored nodes, double whatever the precision of the points.
struct NodeArrays {
  double* mass = nullptr;            // [kg]
  Vec3<double>* velocity = nullptr;  // at the start of the step, from the points [m/s]
  Vec3<double>* arrival =
      nullptr;  // what the ground takes from it at once, where it points into the ground; null in statics [m/s]
  Vec3<double>* acceleration = nullptr;  // at the start of the step [m/s2]
  Vec3<double>* external = nullptr;      // at the end of the step [N]
  Vec3<double>* internal = nullptr;      // for the displacement u [N]
  Vec3<double>* u = nullptr;             // displacement of the step [m]
  Vec3<double>* residual = nullptr;      // unbalanced force, freed directions only [N]
  Sym3<double>* freed = nullptr;         // projector on the directions a node may move in
  Touch* touch = nullptr;

  /// Velocity that the step begins with.
  TALUS_HD Vec3<double> begin_velocity(int n) const { return arrival ? velocity[n] + arrival[n] : velocity[n]; }
};

/// Mass, momentum, acceleration (as mass times it) and loads of the points to the nodes.
template <class Real, class Shape>
struct ScatterInertia : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 10;
  Materials<Real> materials;
  bool affine, accelerated;
  const Vec3<double>* loads;  // force per volume of each load at the end of the step [N/m3]; null without loads
  NodeArrays nodes;

  struct Source : PointGradients<Real, Shape> {
    Real mass;
    Vec3<Real> corner;  // velocity at the first node
    Mat3<Real> turn{};  // its change per node
    Vec3<double> acceleration{}, load{};
    TALUS_HD Source(const ScatterInertia& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      const ParticleView<Real>& points = k.points;
      mass = points.volume[p] * k.materials.density(points.material, p);
      corner = points.velocity_of(p);
      if (k.affine) {
        turn = points.affine_of(p);
        corner += turn * Vec3<Real>{this->s.near_x, this->s.near_y, this->s.near_z};
      }
      if (k.accelerated)
        acceleration =
            widen(Vec3<Real>{points.acceleration[0][p], points.acceleration[1][p], points.acceleration[2][p]});
      if (k.loads && points.load[p] >= 0) load = k.loads[points.load[p]] * static_cast<double>(points.volume[p]);
    }
  };
  struct Sums {
    double mass = 0;
    Vec3<double> momentum, acceleration, load;
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    const int a = Base::along_x(q), b = Base::along_y(q);
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) {
      const double w = static_cast<double>(g.weight(a, b, c)), share = w * static_cast<double>(g.mass);
      sums[c].mass += share;
      sums[c].momentum += widen(g.corner + g.turn * Vec3<Real>{Real(a), Real(b), Real(c)}) * share;
      sums[c].acceleration += g.acceleration * share;
      sums[c].load += g.load * w;
    }
  }
  TALUS_HD void give_to(int at, const Sums& sums) const {
    talus::scatter_add(&nodes.mass[at], sums.mass);
    scatter_add(&nodes.velocity[at], sums.momentum);
    if (accelerated) scatter_add(&nodes.acceleration[at], sums.acceleration);
    if (loads) scatter_add(&nodes.external[at], sums.load);
  }
  TALUS_HD static void store(const Sums& sums, double* to) {
    to[0] = sums.mass;
    put(sums.momentum, to + 1);
    put(sums.acceleration, to + 4);
    put(sums.load, to + 7);
  }
  TALUS_HD bool has(int q) const { return q < 4 || (q < 7 ? accelerated : loads != nullptr); }
  TALUS_HD double* part(int node, int q) const {
    return q == 0  ? &nodes.mass[node]
           : q < 4 ? &nodes.velocity[node].x + (q - 1)
           : q < 7 ? &nodes.acceleration[node].x + (q - 4)
                   : &nodes.external[node].x + (q - 7);
  }
};

/// The tangents of all points, number by number; in single precision where Newton corrects what that rounds off.
template <class Real>
struct TangentStore {
  static constexpr int numbers = sizeof(PointTangent<Real>) / sizeof(Real);
  Real* data = nullptr;
  int count = 0;
  float* single = nullptr;  // in place of `data`

  TALUS_HD bool on() const { return data || single; }
  double bytes_each() const { return on() ? numbers * static_cast<double>(single ? sizeof(float) : sizeof(Real)) : 0; }
  TALUS_HD void put(int p, const PointTangent<Real>& t) const {
    const Real* values = t.axes;
    if (single) {
      for (int q = 0; q < numbers; ++q) single[at(q, p)] = static_cast<float>(values[q]);
    } else {
      for (int q = 0; q < numbers; ++q) data[at(q, p)] = values[q];
    }
  }
  TALUS_HD PointTangent<Real> get(int p) const {
    PointTangent<Real> t;
    Real* values = t.axes;
    if (single) {
      for (int q = 0; q < numbers; ++q) values[q] = static_cast<Real>(single[at(q, p)]);
    } else {
      for (int q = 0; q < numbers; ++q) values[q] = data[at(q, p)];
    }
    return t;
  }

 private:
  TALUS_HD std::size_t at(int q, int p) const {
    return static_cast<std::size_t>(q) * static_cast<std::size_t>(count) + static_cast<std::size_t>(p);
  }
};

template <class Real>
TALUS_HD MaterialState<Real> state_of(const ParticleView<Real>& points, int p, bool dilatant) {
  return {points.elastic_of(p), points.log_volume[p], dilatant ? points.plastic_log_volume[p] : Real(0)};
}

/// Displacement gradient of a point over the start of the step.
template <class Real, class Shape>
TALUS_HD Mat3<Real> displacement_gradient(const GridView<Real>& grid, const PointGradients<Real, Shape>& g,
                                          const Vec3<double>* u) {
  Mat3<Real> gradient{};
  around(grid, g, [&](int n, int a, int b, int c) { add_outer(gradient, narrow<Real>(u[n]), g.gradient(a, b, c)); });
  return gradient;
}

/// What the points' stresses, or their changes, give to the nodes: V P grad N, P = law(p, its gradients), which may
/// keep what belongs to the point.
template <class Real, class Shape, class Law>
struct ScatterForces : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Named = Law;
  using Number = double;
  static constexpr int parts = 3, tiles_at_once = Law::tiles_at_once;
  Law law;
  Vec3<double>* forces;
  const CgState* loop = nullptr;  // that it is part of; does nothing once it is over

  double bytes(int count) const {
    return law.bytes(count) + count * (this->points.place_bytes + sizeof(Real)) +
           this->grid.nodes * 3.0 * sizeof(*forces);
  }

  struct Source : PointGradients<Real, Shape> {
    Mat3<Real> pull;
    TALUS_HD Source(const ScatterForces& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      pull = k.law(k.grid, k.points, p, *this);
      const Real volume = k.points.volume[p];
      pull = {pull.a * volume, pull.b * volume, pull.c * volume};
    }
  };
  using Sums = Vec3<double>;

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD bool counts(int p) const { return Base::counts(p) && (!loop || loop->halt == CgState::no); }
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) sums[c] += widen(g.pull * g.gradient(Base::along_x(q), Base::along_y(q), c));
  }
  TALUS_HD void give_to(int at, const Sums& sums) const { scatter_add(&forces[at], sums); }
  TALUS_HD static void store(const Sums& sums, double* to) { put(sums, to); }
  TALUS_HD double* part(int node, int q) const { return &forces[node].x + q; }
};

/// Stress for the displacement u; the tangent as well where there is a store for it.
template <class Real, class Shape>
struct StressAt {
  static constexpr int tiles_at_once = 0;
  Materials<Real> materials;
  bool dilatant;
  bool definite;  // without the part of the tangent that compression makes negative
  MeanDilationView<Real> means;
  TangentStore<Real> tangents;
  const Vec3<double>* u;

  double bytes(int count) const { return count * (7.0 * sizeof(Real) + tangents.bytes_each()); }
  TALUS_HD Mat3<Real> operator()(const GridView<Real>& grid, const ParticleView<Real>& points, int p,
                                 const PointGradients<Real, Shape>& g) const {
    PointTangent<Real> tangent;
    const Mat3<Real> stress =
        nominal_stress(materials.of(points.material, points.plastic_shear, p), state_of(points, p, dilatant),
                       displacement_gradient(grid, g, u), tangents.on() ? &tangent : nullptr, means.at_point(p));
    if (tangents.on() && definite) make_definite(tangent);
    if (tangents.on()) tangents.put(p, tangent);
    return stress;
  }
};

/// Change of the stress for a displacement x, by the tangents: K x, point by point, never assembled.
template <class Real, class Shape>
struct TangentTimes {
  static constexpr int tiles_at_once = 8;  // worth the few registers that go through memory
  TangentStore<Real> tangents;
  const Vec3<double>* x;

  double bytes(int count) const { return count * tangents.bytes_each(); }
  TALUS_HD Mat3<Real> operator()(const GridView<Real>& grid, const ParticleView<Real>&, int p,
                                 const PointGradients<Real, Shape>& g) const {
    return apply(tangents.get(p), displacement_gradient(grid, g, x));
  }
};

/// One thread: one point. How far it goes for the displacement u, over how far it may: the largest over all points, as
/// float bits. In a dynamic step, and on sloping ground, it may go a cell. Statics over level ground are exact however
/// far it goes, short of going half a cell through an edge that it was too far from to meet.
template <class Real, class Shape>
struct MeasureMotion {
  GridView<Real> grid;
  ParticleView<Real> points;
  const Vec3<double>* u;
  bool dynamic;
  std::uint32_t* farthest;
  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    Vec3<double> way{};
    around(grid, g, [&](int n, int a, int b, int c) { way += u[n] * static_cast<double>(g.weight(a, b, c)); });
    const double across = static_cast<double>(g.across), up = static_cast<double>(g.up);
    const double rise = way.z - static_cast<double>(g.s.slope_x) * way.x - static_cast<double>(g.s.slope_y) * way.y;
    double cells = fmax(fmax(fabs(way.x), fabs(way.y)) * across, fabs(rise) * up);
    if (!dynamic && g.s.slope_x == Real(0) && g.s.slope_y == Real(0)) {
      const double x = points.cell_x[p] + static_cast<double>(points.offset_x[p]) + way.x * across;
      const double y = points.cell_y[p] + static_cast<double>(points.offset_y[p]) + way.y * across;
      const double z = points.cell_z[p] + static_cast<double>(points.offset_z[p]) + rise * up;
      const double through_x = fmax(grid.walls.west - x, x - grid.walls.east),
                   through_y = fmax(grid.walls.south - y, y - grid.walls.north);
      cells = 2 * fmax(fmax(through_x, through_y), fmax(-z, 0.0));
    }
    atomic_max_positive(farthest, cells < 1e30 ? static_cast<float>(cells) : 1e30f);
  }
};

/// One thread: one point. State, velocity and position at the end of an accepted step.
template <class Real, class Shape>
struct AcceptStep {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  Clock* clock;
  NodeArrays nodes;                  // velocity, acceleration: at the start
  const Vec3<double>* new_velocity;  // at the end; null in statics
  const Vec3<double>* new_acceleration;
  const Vec3<double>* strain_displacement;  // what the strain comes from: u, or dt times the remapped velocity
  double kept;                              // share of the points' velocity finer than the grid that stays
  bool affine, dilatant;
  bool speeds, deforms;          // MUSL takes the velocity first and the rest later
  MeanDilationView<Real> means;  // of strain_displacement

  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    const Vec3<double> move = gather_motion(p, g);
    if (!deforms) return;
    const Mat3<Real> gradient = displacement_gradient(grid, g, strain_displacement);
    MaterialState<Real> state = state_of(points, p, dilatant);
    advance_material(materials.of(points.material, points.plastic_shear, p), gradient, state, means.at_point(p));
    if (points.plastic_shear) points.plastic_shear[p] += state.plastic_shear;
    points.set_elastic(p, state.elastic);
    points.log_volume[p] = state.log_volume;
    if (dilatant) points.plastic_log_volume[p] = state.plastic_log_volume;
    if constexpr (Shape::averaged) points.stretch_box(p, gradient, g.s.slope_x, g.s.slope_y);
    const double across = static_cast<double>(grid.spacing), up = static_cast<double>(grid.layer_height);
    points.move_by(p, Vec3<double>{move.x / across, move.y / across, move.z / up}, grid.walls);
    settle(p, g);
  }

 private:
  /// New velocity, acceleration and affine velocity; returns the way in reference coordinates [m].
  TALUS_HD Vec3<double> gather_motion(int p, const PointGradients<Real, Shape>& g) const {
    const bool follows = grid.mapping == Mapping::terrain_following;
    Vec3<double> u{}, v{}, a1{};
    double climb = 0;
    Mat3<double> moment{}, slope{};
    around(grid, g, [&](int n, int a, int b, int c) {
      const double w = static_cast<double>(g.weight(a, b, c));
      u += nodes.u[n] * w;
      double nx = 0, ny = 0;
      if (follows) {
        const int column = grid.column(g.s.i + a, g.s.j + b);
        nx = static_cast<double>(grid.slope_x[column]);
        ny = static_cast<double>(grid.slope_y[column]);
      }
      climb += w * (nodes.u[n].z - nx * nodes.u[n].x - ny * nodes.u[n].y);
      if (!new_velocity || !speeds) return;
      v += (new_velocity[n] - nodes.velocity[n] * kept) * w;
      a1 += new_acceleration[n] * w;
      if (!affine) return;
      const Vec3<double> arm{static_cast<double>(g.s.near_x) + a, static_cast<double>(g.s.near_y) + b,
                             static_cast<double>(g.s.near_z) + c};
      add_outer(moment, new_velocity[n], arm * w);
      const Vec3<double> gradient{static_cast<double>(g.s.gx[a] * g.s.wy[b] * g.s.wz[c]),
                                  static_cast<double>(g.s.wx[a] * g.s.gy[b] * g.s.wz[c]),
                                  static_cast<double>(g.s.wx[a] * g.s.wy[b] * g.s.gz[c])};
      add_outer(slope, new_velocity[n], gradient);
    });
    if (new_velocity && speeds) {
      if (kept > 0) v += widen(points.velocity_of(p)) * kept;
      store(points.velocity, p, v);
      store(points.acceleration, p, a1);
      if (affine) points.set_affine(p, g.s.affine_velocity(moment, slope));
    }
    return {u.x, u.y, climb};
  }

  TALUS_HD static void store(Real* const target[3], int p, const Vec3<double>& v) {
    target[0][p] = static_cast<Real>(v.x);
    target[1][p] = static_cast<Real>(v.y);
    target[2][p] = static_cast<Real>(v.z);
  }

  TALUS_HD void settle(int p, const PointGradients<Real, Shape>& g) const {
    const Real speed = length(points.velocity_of(p));
    if (!(speed < Real(1e6)) || !(fabs(points.log_volume[p]) < Real(1e3))) {
      raise_flag(&clock->failed_point, points.id[p]);
      raise_flag(&clock->request, failed);
      return;
    }
    if (grid.ground == GroundContact::points) keep_above_ground(grid, points, p);
    const int i = points.cell_x[p], j = points.cell_y[p];
    if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows || !grid.open[grid.column(i, j)]) {
      points.cell_x[p] = -1;
      atomic_add(&clock->outflow_volume, static_cast<double>(points.volume[p]));
      atomic_increment(&clock->outflow_count);
      return;
    }
    const Real steep = Real(1) + g.s.slope_x * g.s.slope_x + g.s.slope_y * g.s.slope_y;
    const Real wave_speed =
        points.material ? materials.list[points.material[p]].wave_speed : materials.list[0].wave_speed;
    const Real waves = wave_speed * sqrt(Real(2) * g.across * g.across + steep * g.up * g.up);
    atomic_max_positive(&clock->rate_bits, static_cast<float>(waves + speed * (g.across + g.across + g.up)));
    atomic_max_positive(&clock->speed_bits, static_cast<float>(speed));
  }
};

/// Momentum of the points' new velocity back to the nodes (MUSL).
template <class Real, class Shape>
struct ScatterVelocity : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 3;
  Materials<Real> materials;
  Vec3<double>* momentum;

  struct Source : PointGradients<Real, Shape> {
    Vec3<double> momentum;
    TALUS_HD Source(const ScatterVelocity& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      momentum = widen(k.points.velocity_of(p)) *
                 static_cast<double>(k.points.volume[p] * k.materials.density(k.points.material, p));
    }
  };
  using Sums = Vec3<double>;

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c)
      sums[c] += g.momentum * static_cast<double>(g.weight(Base::along_x(q), Base::along_y(q), c));
  }
  TALUS_HD void give_to(int at, const Sums& sums) const { scatter_add(&momentum[at], sums); }
  TALUS_HD static void store(const Sums& sums, double* to) { put(sums, to); }
  TALUS_HD double* part(int node, int q) const { return &momentum[node].x + q; }
};

}  // namespace talus::solver
