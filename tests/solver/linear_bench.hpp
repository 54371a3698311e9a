// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of the linear algebra share: random points on wavy ground with their tangents, masses and constraints.
#pragma once

#include <random>

#include "solver/elements/forces.hpp"
#include "solver/elements/point_tangents.hpp"
#include "solver/implicit/transfer.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"
#include "solver/linear/operator/tangent_operator.hpp"
#include "solver/linear/preconditioner/preconditioner.hpp"
#include "solver/parallel/tiles.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

struct Setting {
  ShapeKind shape;
  Mapping mapping = Mapping::terrain_following;
  MaterialModel model = MaterialModel::hencky;
  bool b_bar = false, springs = false;
};

/// Points off their lattice on wavy ground, with random strains, under a random displacement of the grid.
inline Scene random_scene(const Setting& setting) {
  Domain d = ground(14, 12, 2.0, 1.0, [](double x, double y) { return 3 - 0.1 * x + 0.3 * std::sin(y); });
  fill(d, {8, 14, 8, 14, 0, 3});
  SolveOptions o;
  o.shape = setting.shape;
  o.mapping = setting.mapping;
  Scene s = make_scene(d, o);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t p = 0; p < s.points.size(); ++p) {
    for (int a = 0; a < 3; ++a) {
      const double lowest = a == 2 && s.points.cell[2][p] == 0 ? 0.0 : -0.5;
      s.points.offset[a][p] = std::clamp(s.points.offset[a][p] + 0.2 * u(engine), lowest, 0.499);
    }
    for (auto& component : s.points.elastic) component[p] = 0.01 * u(engine);
    s.points.log_volume[p] = s.points.elastic[0][p] + s.points.elastic[1][p] + s.points.elastic[2][p];
  }
  return s;
}

inline std::vector<Vec3<double>> random_vectors(int count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> u(-size, size);
  std::vector<Vec3<double>> v(static_cast<std::size_t>(count));
  for (auto& x : v) x = {u(engine), u(engine), u(engine)};
  return v;
}

inline double norm(const std::vector<Vec3<double>>& v) {
  double sum = 0;
  for (const auto& x : v) sum += dot(x, x);
  return std::sqrt(sum);
}

inline double difference(const std::vector<Vec3<double>>& a, const std::vector<Vec3<double>>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<Vec3<double>> d(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) d[n] = a[n] - b[n];
  return norm(d) / norm(b);
}

inline Sym3<double> plane(const Vec3<double>& n) {
  return {1 - n.x * n.x, 1 - n.y * n.y, 1 - n.z * n.z, -n.x * n.y, -n.y * n.z, -n.x * n.z};
}

/// y = freed (y + (mass inertia + stiffness) x)
struct CloseSystem {
  HeldNodes nodes;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int n) const {
    y[n] = nodes.freed[n] * (y[n] + x[n] * (nodes.mass[n] * nodes.inertia) + nodes.stiffness[n] * x[n]);
  }
};

/// One thread: one point. Its tangent, many times.
template <class Real>
struct Stiffen {
  ParticleView<Real> points;
  TangentStore<Real> tangents;
  int from;
  Real times;
  TALUS_HD void operator()(int p) const {
    if (points.cell[0][p] < from) return;
    PointTangent<Real> t = tangents.get(p);
    for (Real& d : t.direct) d *= times;
    for (Real& s : t.pairs) s *= times;
    tangents.put(p, t);
  }
};

/// One thread: one point.
template <class Real>
struct CopyTangent {
  TangentStore<Real> from, to;
  TALUS_HD void operator()(int p) const { to.put(p, from.get(p)); }
};

/// Everything a linear solve takes: grid, points, tangents, mass and constraints.
template <class Real, class Device, class Shape>
struct LinearBench {
  Device device = Device::make();
  Particles<Real, Device> points{device, {.boxes = Shape::averaged}};
  SparseGrid<Real, Device> grid;
  ElementList<Real, Device, Shape> elements{device};
  Materials<Real> materials;
  int count = 0;
  Buffer<Real, Device> tangents{device};
  Buffer<double, Device> mass{device};
  Buffer<Sym3<double>, Device> freed{device}, stiffness{device};
  MeanDilation<Real, Device, Shape> means{device};
  bool b_bar;
  FillerSprings springs;
  NodeVector<Device> velocity{device}, internal{device}, u{device};
  double inertia = 1e3;

  explicit LinearBench(const Setting& setting) : LinearBench(random_scene(setting), setting) {}
  LinearBench(const Scene& scene, const Setting& setting) : grid(device, scene.grid, {}), b_bar(setting.b_bar) {
    points.upload(scene.points);
    MaterialOptions mo;
    mo.model = setting.model;
    materials.list[0] = make_material<Real>(mo);
    grid.fit(points, 0);
    count = grid.nodes();
    elements.build(grid.view(), points.view());
    refresh();
    if (setting.springs) {
      const double full = static_cast<double>(materials.list[0].density) * scene.grid.spacing * scene.grid.spacing *
                          scene.grid.layer_height;
      springs = {mass.data(), 0.5 * full, 1e6};
    }
    hold();
  }

  NodeArrays nodes() {
    NodeArrays n;
    n.mass = mass.data();
    n.velocity = velocity.data();
    n.internal = internal.data();
    n.u = u.data();
    n.freed = freed.data();
    return n;
  }
  TangentStore<Real> store() { return {tangents.data(), points.count()}; }
  PointTangents<Real> from() { return {grid.view(), points.view(), store(), mean_view(), springs}; }
  MeanDilationView<Real> mean_view() const { return b_bar ? means.view() : MeanDilationView<Real>{}; }
  HeldNodes held() const { return {count, mass.data(), freed.data(), inertia, 0.0, stiffness.data()}; }

  void refresh() {
    const auto n = static_cast<std::size_t>(count);
    u.upload(random_vectors(count, 0.01, 3));
    for (auto* v : {&velocity, &internal}) {
      v->resize(n);
      v->fill_zero();
    }
    mass.resize(n);
    mass.fill_zero();
    tangents.resize(static_cast<std::size_t>(TangentStore<Real>::numbers) * static_cast<std::size_t>(points.count()));
    scatter_points(
        device, points.count(), grid.groups(),
        ScatterInertia<Real, Shape>{{grid.view(), points.view()}, materials, false, false, nullptr, nodes()});
    if (b_bar) means.begin_step(elements, points.count());
    measure_stress();
  }

  static constexpr double step_seconds = 0.01;  // which no elastic law looks at

  /// Internal force and tangents for the displacement u.
  void measure_stress() {
    internal.fill_zero();
    if (b_bar) means.measure(elements, grid.view(), points.view(), materials, {u.data(), step_seconds, false});
    using Stress = StressAt<Real, Shape>;
    scatter_points(device, points.count(), grid.groups(),
                   ScatterForces<Real, Shape, Stress>{
                       {grid.view(), points.view()},
                       Stress{materials, false, false, mean_view(), store(), u.data(), Real(step_seconds)},
                       internal.data()});
    if (springs.on()) apply_springs(elements, springs, u, internal);
    synchronise(device);
  }

  /// Held, slipping on a tilted plane, sliding along a line, free; some on springs.
  void hold() {
    const auto m = mass.download();
    std::vector<Sym3<double>> p(m.size()), own(m.size());
    for (std::size_t n = 0; n < m.size(); n += 5) own[n] = {2e6, 3e6, 1e6, 5e5, -4e5, 0};
    stiffness.upload(own);
    for (std::size_t n = 0; n < m.size(); ++n) {
      if (!(m[n] > 0) || n % 11 == 0) continue;
      p[n] = {1, 1, 1, 0, 0, 0};
      if (n % 7 == 0) p[n] = plane({-0.36, 0.48, 0.8});
      if (n % 13 == 0) p[n] = {0.36, 0.64, 0, 0.48, 0, 0};
    }
    freed.upload(p);
  }
  void free_all() {
    const auto m = mass.download();
    std::vector<Sym3<double>> p(m.size());
    for (std::size_t n = 0; n < m.size(); ++n) p[n] = m[n] > 0 ? Sym3<double>{1, 1, 1, 0, 0, 0} : Sym3<double>{};
    freed.upload(p);
    stiffness.fill_zero();
  }

  /// Calls f(i, j, k, n) for every stored node.
  template <class F>
  void for_nodes(F&& f) const {
    for_stored_nodes(grid.view(), slots_of(grid), f);
  }
  /// The base nodes slide on level ground, all others are free.
  void lay_down() {
    free_all();
    auto p = freed.download();
    for_nodes([&](int, int, int k, std::size_t n) {
      if (k == 0) p[n].zz = 0;
    });
    freed.upload(p);
  }

  /// Points from column `from` on are so many times as stiff, and their nodes as heavy.
  void contrast(int from, double stiffer, double heavier) {
    for_each(device, points.count(), Stiffen<Real>{points.view(), store(), from, static_cast<Real>(stiffer)});
    auto m = mass.download();
    for_nodes([&](int i, int, int, std::size_t n) {
      if (i >= from) m[n] *= heavier;
    });
    mass.upload(m);
  }

  /// K x point by point, by tangents in single precision where `single`.
  std::vector<Vec3<double>> product(bool single = false) {
    TangentOperator<Real, Device, Shape> op(device);
    op.begin_step(elements);
    PointTangents<Real> tangents_of_points = from();
    Buffer<float, Device> narrow(device);
    if (single) {
      narrow.resize(tangents.size());
      tangents_of_points.tangents = {nullptr, points.count(), narrow.data()};
      for_each(device, points.count(), CopyTangent<Real>{store(), tangents_of_points.tangents});
    }
    op.refresh(tangents_of_points, grid.groups());
    NodeVector<Device> x(device), y(device);
    x.upload(random_vectors(count, 1, 5));
    y.resize(x.size());
    y.fill_zero();
    op.apply(x, y);
    synchronise(device);
    return y.download();
  }

  NodeVector<Device> right_side() {
    NodeVector<Device> b(device);
    const auto p = freed.download();
    auto v = random_vectors(count, 1e4, 9);
    for (std::size_t n = 0; n < v.size(); ++n) v[n] = p[n] * v[n];
    b.upload(v);
    return b;
  }

  std::vector<Vec3<double>> by_gradients(int* iterations = nullptr, double tolerance = 1e-12) {
    NodeVector<Device> x(device);
    const NodeVector<Device> b = right_side();
    NodePreconditioner<Real, Device, Shape> preconditioner(device);
    preconditioner.refresh(from(), grid.groups(), elements, held());
    TangentOperator<Real, Device, Shape> op(device);
    op.begin_step(elements);
    op.refresh(from(), grid.groups());
    ConjugateGradient<Device> cg(device);
    struct Product {
      TangentOperator<Real, Device, Shape>& op;
      HeldNodes held;
      void add_product(const NodeVector<Device>& p, NodeVector<Device>& ap, const int* halted) {
        op.apply(p, ap, halted);
      }
      CloseSystem closing(const NodeVector<Device>& p, NodeVector<Device>& ap) { return {held, p.data(), ap.data()}; }
    };
    const LinearReport report =
        cg.solve(Product{op, held()}, preconditioner, b, x, {.tolerance = tolerance, .iterations = 5000});
    EXPECT_TRUE(report.converged) << "residual " << report.residual;
    if (iterations) *iterations = report.iterations;
    return x.download();
  }

  std::vector<Vec3<double>> by_cholesky() {
    CholeskySolver<Real, Device, Shape> solver(device);
    solver.begin_step(elements);
    NodeVector<Device> x(device);
    const LinearReport report = solver.solve(from(), held(), right_side(), x);
    EXPECT_TRUE(report.converged) << solver.factor().name() << ": residual " << report.residual;
    EXPECT_FALSE(report.indefinite);
    return x.download();
  }
};

#if TALUS_FOR_GPU
#define TALUS_RUN(function, ...)                                                \
  (GetParam() == On::gpu ? function<double, GpuDevice, Linear>(__VA_ARGS__)     \
                         : function<double, CpuDevice, Linear>(__VA_ARGS__),    \
   GetParam() == On::gpu ? function<double, GpuDevice, Quadratic>(__VA_ARGS__)  \
                         : function<double, CpuDevice, Quadratic>(__VA_ARGS__), \
   GetParam() == On::gpu ? function<double, GpuDevice, Gimp>(__VA_ARGS__)       \
                         : function<double, CpuDevice, Gimp>(__VA_ARGS__))
#else
#define TALUS_RUN(function, ...)                                                                          \
  (function<double, CpuDevice, Linear>(__VA_ARGS__), function<double, CpuDevice, Quadratic>(__VA_ARGS__), \
   function<double, CpuDevice, Gimp>(__VA_ARGS__))
#endif

}  // namespace talus::solver::testing
