// Kernels of an implicit step: inertia and loads to the grid, stress and tangent of the points for a displacement of the grid, the
// tangent's product with a vector, its diagonal blocks, and the way back to the points.
#pragma once

#include "solver/contact/walls.hpp"
#include "solver/grid/bicubic.hpp"
#include "solver/integrator/clock.hpp"
#include "solver/linear/mean_dilation.hpp"
#include "solver/material/tangent.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// Where a node stands with the surface it can touch (ground or a frictional wall): away from it, slipping along it, or stuck to it.
enum class Touch : unsigned char { none, open, slips, sticks };

/// Arrays over the stored nodes, double whatever the precision of the points.
struct NodeArrays {
  double* mass = nullptr;                // [kg]
  Vec3<double>* velocity = nullptr;      // at the start of the step, from the points [m/s]
  Vec3<double>* arrival = nullptr;       // what the ground takes from it at once, where it points into the ground; null in statics [m/s]
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

/// Interpolation of a point once more, in double, with gradients by position [1/m].
template <class Real, class Shape>
struct PointGradients {
  Stencil<Real, Shape> s;
  Real across, up;
  TALUS_HD PointGradients(const GridView<Real>& grid, const ParticleView<Real>& points, int p)
      : s(grid, points, p), across(Real(1) / grid.spacing), up(Real(1) / grid.layer_height) {}
  TALUS_HD Real weight(int a, int b, int c) const { return s.wx[a] * s.wy[b] * s.wz[c]; }
  TALUS_HD Vec3<Real> gradient(int a, int b, int c) const {
    const Real gz = s.wx[a] * s.wy[b] * s.gz[c] * up;
    return {s.gx[a] * s.wy[b] * s.wz[c] * across - s.slope_x * gz, s.wx[a] * s.gy[b] * s.wz[c] * across - s.slope_y * gz, gz};
  }
  TALUS_HD int node(const GridView<Real>& grid, int a, int b, int c) const {
    const int layer = s.k + c > 0 ? s.k + c : 0;
    return GridView<Real>::node(grid.slot(s.i + a, s.j + b), s.i + a, s.j + b, layer);
  }
};

/// Calls f(node, a, b, c) for every node around a point.
template <class Real, class Shape, class F>
TALUS_HD void around(const GridView<Real>& grid, const PointGradients<Real, Shape>& g, F&& f) {
  for (int b = 0; b < Shape::width; ++b) {
    for (int a = 0; a < Shape::width; ++a) {
      for (int c = 0; c < Shape::width; ++c) f(g.node(grid, a, b, c), a, b, c);
    }
  }
}

template <class Real>
TALUS_HD Vec3<double> widen(const Vec3<Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
template <class Real>
TALUS_HD Vec3<Real> narrow(const Vec3<double>& v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}
using talus::scatter_add;

/// One thread: one point. Mass, momentum, acceleration (as mass times it) and loads to the nodes.
template <class Real, class Shape>
struct ScatterInertia {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  bool affine, accelerated;
  const Vec3<double>* loads;  // force per volume of each load at the end of the step [N/m3]; null without loads
  NodeArrays nodes;

  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    const Real mass = points.volume[p] * materials.density(points.material, p);
    const Vec3<Real> v = points.velocity_of(p);
    const Mat3<Real> turn = affine ? points.affine_of(p) : Mat3<Real>{};
    Vec3<double> acceleration{}, load{};
    if (accelerated) acceleration = widen(Vec3<Real>{points.acceleration[0][p], points.acceleration[1][p], points.acceleration[2][p]});
    if (loads && points.load[p] >= 0) load = loads[points.load[p]] * static_cast<double>(points.volume[p]);
    around(grid, g, [&](int n, int a, int b, int c) {
      const double w = static_cast<double>(g.weight(a, b, c));
      const double share = w * static_cast<double>(mass);
      const Vec3<Real> there = v + turn * Vec3<Real>{g.s.near_x + Real(a), g.s.near_y + Real(b), g.s.near_z + Real(c)};
      talus::scatter_add(&nodes.mass[n], share);
      scatter_add(&nodes.velocity[n], widen(there) * share);
      if (accelerated) scatter_add(&nodes.acceleration[n], acceleration * share);
      if (loads) scatter_add(&nodes.external[n], load * w);
    });
  }
};

/// The tangents of all points, number by number.
template <class Real>
struct TangentStore {
  static constexpr int numbers = sizeof(PointTangent<Real>) / sizeof(Real);
  Real* data = nullptr;
  int count = 0;
  TALUS_HD void put(int p, const PointTangent<Real>& t) const {
    const Real* values = t.axes;
    for (int q = 0; q < numbers; ++q) data[at(q, p)] = values[q];
  }
  TALUS_HD PointTangent<Real> get(int p) const {
    PointTangent<Real> t;
    Real* values = t.axes;
    for (int q = 0; q < numbers; ++q) values[q] = data[at(q, p)];
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
TALUS_HD Mat3<Real> displacement_gradient(const GridView<Real>& grid, const PointGradients<Real, Shape>& g, const Vec3<double>* u) {
  Mat3<Real> gradient{};
  around(grid, g, [&](int n, int a, int b, int c) { add_outer(gradient, narrow<Real>(u[n]), g.gradient(a, b, c)); });
  return gradient;
}

/// One thread: one point. Internal force for the displacement u; the tangent as well where `tangents` has data.
template <class Real, class Shape>
struct ScatterStress {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  bool dilatant;
  bool definite;  // without the part of the tangent that compression makes negative
  MeanDilationView<Real> means;
  TangentStore<Real> tangents;
  NodeArrays nodes;

  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    PointTangent<Real> tangent;
    const Material<Real> material = materials.of(points.material, points.plastic_shear, p);
    const Mat3<Real> stress = nominal_stress(material, state_of(points, p, dilatant), displacement_gradient(grid, g, nodes.u),
                                             tangents.data ? &tangent : nullptr, means.at_point(p));
    if (tangents.data && definite) make_definite(tangent);
    if (tangents.data) tangents.put(p, tangent);
    const Real volume = points.volume[p];
    around(grid, g, [&](int n, int a, int b, int c) {
      scatter_add(&nodes.internal[n], widen(stress * (g.gradient(a, b, c) * volume)));
    });
  }
};

/// One thread: one point. y += K x, point by point, never assembled.
template <class Real, class Shape>
struct ApplyTangent {
  GridView<Real> grid;
  ParticleView<Real> points;
  TangentStore<Real> tangents;
  const Vec3<double>* x;
  Vec3<double>* y;

  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    const Mat3<Real> change = apply(tangents.get(p), displacement_gradient(grid, g, x));
    const Real volume = points.volume[p];
    around(grid, g, [&](int n, int a, int b, int c) { scatter_add(&y[n], widen(change * (g.gradient(a, b, c) * volume))); });
  }
};

/// One thread: one point. How far it goes for the displacement u, over how far it may: the largest over all points, as float bits. In a dynamic step,
/// and on sloping ground, it may go a cell. Statics over level ground are exact however far it goes, short of going half a cell through an edge that
/// it was too far from to meet.
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
      const double through_x = fmax(grid.walls.west - x, x - grid.walls.east), through_y = fmax(grid.walls.south - y, y - grid.walls.north);
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
  NodeArrays nodes;                       // velocity, acceleration: at the start
  const Vec3<double>* new_velocity;       // at the end; null in statics
  const Vec3<double>* new_acceleration;
  const Vec3<double>* strain_displacement;  // what the strain comes from: u, or dt times the remapped velocity
  double kept;                            // share of the points' velocity finer than the grid that stays
  bool affine, dilatant;
  bool speeds, deforms;                   // MUSL takes the velocity first and the rest later
  MeanDilationView<Real> means;           // of strain_displacement

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
    const Real wave_speed = points.material ? materials.list[points.material[p]].wave_speed : materials.list[0].wave_speed;
    const Real waves = wave_speed * sqrt(Real(2) * g.across * g.across + steep * g.up * g.up);
    atomic_max_positive(&clock->rate_bits, static_cast<float>(waves + speed * (g.across + g.across + g.up)));
    atomic_max_positive(&clock->speed_bits, static_cast<float>(speed));
  }
};

/// One thread: one point. Momentum of the points' new velocity back to the nodes (MUSL).
template <class Real, class Shape>
struct ScatterVelocity {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  Vec3<double>* momentum;
  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    const Vec3<double> v = widen(points.velocity_of(p)) * static_cast<double>(points.volume[p] * materials.density(points.material, p));
    around(grid, g, [&](int n, int a, int b, int c) { scatter_add(&momentum[n], v * static_cast<double>(g.weight(a, b, c))); });
  }
};

}  // namespace talus::solver
