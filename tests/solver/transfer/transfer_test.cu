// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// P2G and G2P against a plain reference: dense sums in double, written from the definitions.
#include <numeric>
#include <random>

#include "solver/integrator/scene.hpp"
#include "solver/transfer/grid_to_particle.hpp"
#include "solver/transfer/particle_to_grid.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using Node = std::tuple<int, int, int>;

/// One-dimensional weight of node n at position x, from the definition of the functions, and its slope.
struct Weight {
  double value, slope;
};
Weight weight(ShapeKind shape, double x, int n, double extent) {
  const double r = x - n, s = std::abs(r), sign = r < 0 ? -1 : 1;
  const auto hat = [](double q) { return std::max(0.0, 1 - std::abs(q)); };
  if (shape == ShapeKind::linear) return s < 1 ? Weight{1 - s, -sign} : Weight{0, 0};
  if (shape == ShapeKind::gimp) {
    const auto area = [](double q) {
      return q < -1 ? 0 : q < 0 ? 0.5 * (1 + q) * (1 + q) : q < 1 ? 0.5 + q - 0.5 * q * q : 1.0;
    };  // of the hat
    return {(area(r + 0.5 * extent) - area(r - 0.5 * extent)) / extent,
            (hat(r + 0.5 * extent) - hat(r - 0.5 * extent)) / extent};
  }
  if (s < 0.5) return {0.75 - r * r, -2 * r};
  if (s < 1.5) return {0.5 * (1.5 - s) * (1.5 - s), -sign * (1.5 - s)};
  return {0, 0};
}

class Transfers : public InEachPlace {
 protected:
  /// Points with random velocity, affine velocity and strain on wavy ground.
  static Scene scene(ShapeKind shape, Domain& d) {
    d = ground(14, 12, 2.0, 1.0, [](double x, double y) { return 30 - 0.4 * x + 0.2 * std::sin(y); });
    fill(d, {8, 16, 8, 16, 0, 4});
    SolveOptions o;
    o.shape = shape;
    Scene s = make_scene(d, o);
    s.points = with_all_lists(s.points);
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> u(-1, 1);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      for (int a = 0; a < 3; ++a) {
        s.points.velocity[a][p] = u(engine);
        s.points.offset[a][p] =
            std::clamp(s.points.offset[a][p] + 0.2 * u(engine), a == 2 && s.points.cell[2][p] == 0 ? 0.0 : -0.5, 0.499);
      }
      for (auto& extent : s.points.extent) extent[p] *= 1 + 0.4 * u(engine);
      for (auto& component : s.points.affine) component[p] = 0.3 * u(engine);
      for (auto& component : s.points.elastic) component[p] = 1e-3 * u(engine);
    }
    return s;
  }

  /// A point by the definitions: its weights, and what it gives.
  struct ReferencePoint {
    const Scene& s;
    std::size_t p;
    ShapeKind shape;
    double x[3];
    double bx = 0, by = 0;  ///< slope of the ground there
    bool on_base;
    double height;
    Sym3<double> tau;

    ReferencePoint(const Scene& scene, const TerrainTables& tables, std::size_t point, const Material<double>& m,
                   ShapeKind of)
        : s(scene), p(point), shape(of) {
      for (int a = 0; a < 3; ++a) x[a] = s.points.cell[a][p] + s.points.offset[a][p];
      if (shape == ShapeKind::linear)  // weights stop changing a tenth of a cell from every node
        for (double& place : x)
          place = std::floor(place) +
                  std::clamp(place - std::floor(place), s.grid.lowest_weighed, 1 - s.grid.lowest_weighed);
      for (int i = s.points.cell[0][p] - 1; i <= s.points.cell[0][p] + 1; ++i) {
        for (int j = s.points.cell[1][p] - 1; j <= s.points.cell[1][p] + 1; ++j) {
          const double z = tables.terrain[s.grid.index(i, j)] / s.grid.spacing;
          bx += along(0, i).slope * along(1, j).value * z;
          by += along(0, i).value * along(1, j).slope * z;
        }
      }
      // In the lowest half layer quadratic functions are hats, and their weights stop changing a tenth of a layer above
      // the ground; the box of an averaged one ends on the ground.
      on_base = shape != ShapeKind::linear && s.points.cell[2][p] == 0;
      const double nearest = shape == ShapeKind::gimp ? 0.5 * s.points.extent[2][p] : s.grid.lowest_weighed;
      height = on_base ? std::max(x[2], nearest) : x[2];
      MaterialState<double> state;
      state.elastic = {s.points.elastic[0][p], s.points.elastic[1][p], s.points.elastic[2][p],
                       s.points.elastic[3][p], s.points.elastic[4][p], s.points.elastic[5][p]};
      tau = kirchhoff_stress(m, state);
    }
    Weight along(int a, int n) const { return weight(shape, x[a], n, s.points.extent[a][p]); }

    /// The method adds m (v + C (xi - xi_p)) w - dt V tau grad w to node (i, j, k).
    void give(int i, int j, int k, double density, double dt, std::map<Node, Vec4<double>>& nodes) const {
      const Weight wx = along(0, i), wy = along(1, j);
      const ShapeKind upright = on_base && shape == ShapeKind::quadratic ? ShapeKind::linear : shape;
      const Weight wz = weight(upright, height, k, s.points.extent[2][p]);
      const double w = wx.value * wy.value * wz.value;
      if (w == 0) return;
      const double volume = s.points.volume[p], mass = volume * density;
      const double gz = wx.value * wy.value * wz.slope / s.grid.layer_height;
      const Vec3<double> gradient{wx.slope * wy.value * wz.value / s.grid.spacing - bx * gz,
                                  wx.value * wy.slope * wz.value / s.grid.spacing - by * gz, gz};
      const Vec3<double> force = tau * gradient * (-volume * dt);
      const double r[3] = {i - x[0], j - x[1], k - height};
      double v[3];
      for (int a = 0; a < 3; ++a) {
        v[a] = s.points.velocity[a][p];
        for (int b = 0; b < 3; ++b) v[a] += s.points.affine[3 * b + a][p] * r[b];
      }
      Vec4<double>& node = nodes[{i, j, k}];
      node.w += w * mass;
      node.x += w * mass * v[0] + force.x;
      node.y += w * mass * v[1] + force.y;
      node.z += w * mass * v[2] + force.z;
    }
  };

  /// Momentum after one scatter, by the definitions.
  static std::map<Node, Vec4<double>> reference(const Scene& s, const Material<double>& m, double dt, ShapeKind shape) {
    std::map<Node, Vec4<double>> nodes;
    const TerrainTables tables = make_terrain_tables(s.grid);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      const ReferencePoint point(s, tables, p, m, shape);
      for (int i = s.points.cell[0][p] - 2; i <= s.points.cell[0][p] + 2; ++i) {
        for (int j = s.points.cell[1][p] - 2; j <= s.points.cell[1][p] + 2; ++j) {
          for (int k = s.points.cell[2][p] - 2; k <= s.points.cell[2][p] + 2; ++k)
            point.give(i, j, k, m.density, dt, nodes);
        }
      }
    }
    return nodes;
  }

  template <class Real, class Device, class Shape>
  static void compare(double tolerance) {
    compare<Real, Device, Shape>(tolerance, false);
    if (Device::is_gpu)
      compare<Real, Device, Shape>(
          tolerance,
          true);  // tiles find those with the same nodes wherever they have drifted; the CPU goes by the order
  }

  static MaterialOptions hencky() {
    MaterialOptions o;
    o.model = MaterialModel::hencky;
    return o;
  }

  /// The method brings the points into an order by chance.
  template <class Real, class Device>
  static void shuffle(const Device& device, Particles<Real, Device>& points) {
    std::vector<int> order(static_cast<std::size_t>(points.count()));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(11));
    Buffer<int, Device> chance(device);
    chance.upload(order);
    points.reorder(chance, points.count());
  }

  /// The nodes after one scatter of the points, [stored nodes].
  template <class Shape, class Real, class Device>
  static std::vector<Vec4<Real>> scattered(const Device& device, const SparseGrid<Real, Device>& grid,
                                           Particles<Real, Device>& points, double dt) {
    Buffer<Vec4<Real>, Device> nodes(device);
    nodes.resize(static_cast<std::size_t>(grid.nodes()));
    nodes.fill_zero();
    Clock c;
    c.step_size = dt;
    Buffer<Clock, Device> clock(device);
    clock.upload({c});
    scatter_points(device, points.count(), grid.groups(),
                   ParticleToGrid<Real, Shape, Scatter::impulse>{
                       grid.view(), points.view(), Materials<Real>{{make_material<Real>(hencky())}}, clock.data(),
                       nodes.data(), nullptr, nullptr, true, false});
    synchronise(device);
    return nodes.download();
  }

  template <class Real, class Device, class Shape>
  static void compare(double tolerance, bool shuffled) {
    Domain d;
    const Scene s = scene(kind_of<Shape>, d);
    const double dt = 1e-3;
    const auto expected = reference(s, make_material<double>(hencky()), dt, kind_of<Shape>);
    const Device device = Device::make();
    Particles<Real, Device> points(device, {.affine_transfer = true, .boxes = Shape::averaged});
    points.upload(s.points);
    SparseGrid<Real, Device> grid(device, s.grid, {}, false, Shape::width == 2);
    grid.fit(points, 0);
    if (shuffled) shuffle(device, points);
    const auto got = scattered<Shape>(device, grid, points, dt);
    const auto slots = slots_of(grid);
    double scale = 0, worst = 0;
    for (const auto& [where, node] : expected) scale = std::max(scale, std::abs(node.x));
    std::size_t found = 0;
    for (const auto& [where, node] : expected) {
      const int i = std::get<0>(where), j = std::get<1>(where), k = std::get<2>(where);
      const auto& slot = slots[static_cast<std::size_t>((j >> 2) * ((s.grid.columns + 3) / 4) + (i >> 2))];
      const auto& mine = got[static_cast<std::size_t>(GridView<Real>::node(slot, i, j, k))];
      worst = std::max({worst, std::abs(static_cast<double>(mine.w) - node.w),
                        std::abs(static_cast<double>(mine.x) - node.x), std::abs(static_cast<double>(mine.y) - node.y),
                        std::abs(static_cast<double>(mine.z) - node.z)});
      ++found;
    }
    EXPECT_GT(found, 100u);
    EXPECT_LT(worst, tolerance * scale);
  }

  /// The velocity that grows by this much per cell, [component][direction].
  static constexpr double slope[3][3] = {{0.3, -0.1, 0.2}, {0.05, 0.4, -0.3}, {-0.2, 0.1, 0.25}};

  /// The nodes of a linear field of velocity, [stored nodes].
  template <class Real, class Device>
  static std::vector<Vec4<Real>> linear_field(const SparseGrid<Real, Device>& grid) {
    std::vector<Vec4<Real>> field(static_cast<std::size_t>(grid.nodes()));
    const auto slots = slots_of(grid);
    const int blocks_x = (grid.shape().columns + 3) / 4;
    for (int j = 0; j < grid.shape().rows; ++j) {
      for (int i = 0; i < grid.shape().columns; ++i) {
        const auto& slot = slots[static_cast<std::size_t>((j >> 2) * blocks_x + (i >> 2))];
        for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
          auto& node = field[static_cast<std::size_t>(GridView<Real>::node(slot, i, j, k))];
          const auto value = [&](int a) {
            return static_cast<Real>(slope[a][0] * i + slope[a][1] * j + slope[a][2] * k);
          };
          node = {Real(1), value(0), value(1), value(2)};
        }
      }
    }
    return field;
  }

  /// Velocity gather of a linear field in reference coordinates, and the climb, by the definitions.
  template <class Real, class Device, class Shape>
  static void gather_linear_field(double tolerance) {
    Domain d;
    const Scene s = scene(kind_of<Shape>, d);
    const Device device = Device::make();
    Particles<Real, Device> points(device, {.affine_transfer = true, .boxes = Shape::averaged});
    points.upload(s.points);
    SparseGrid<Real, Device> grid(device, s.grid, {});
    grid.fit(points, 0);
    Buffer<Vec4<Real>, Device> nodes(device);
    nodes.upload(linear_field(grid));
    Clock c;
    c.step_size = 0;  // nothing moves
    Buffer<Clock, Device> clock(device);
    clock.upload({c});
    for_each(device, points.count(),
             GridToParticle<Real, Shape, Gather::all, false>{
                 grid.view(), points.view(), Materials<Real>{{make_material<Real>(hencky())}}, clock.data(),
                 nodes.data(), nullptr, grid.home(), true, false});
    synchronise(device);
    const ParticleState got = points.download();
    double worst = 0;
    int checked = 0;
    for (std::size_t p = 0; p < got.size(); ++p) {
      const double nearest = Shape::averaged ? 0.5 * got.extent[2][p] : s.grid.lowest_weighed;
      const auto beside_node = [&](int a) { return std::abs(got.offset[a][p]) < s.grid.lowest_weighed; };
      if (Shape::width == 2 ? beside_node(0) || beside_node(1) || beside_node(2)
                            : got.cell[2][p] == 0 && got.offset[2][p] < nearest)
        continue;
      ++checked;
      for (int a = 0; a < 3; ++a) {
        double v = 0;
        for (int b = 0; b < 3; ++b) {
          v += slope[a][b] * (got.cell[b][p] + got.offset[b][p]);
          worst = std::max(worst, std::abs(got.affine[3 * b + a][p] - slope[a][b]));
        }
        worst = std::max(worst, std::abs(got.velocity[a][p] - v));
      }
    }
    EXPECT_GT(checked, 100);
    EXPECT_LT(worst, tolerance);
  }
};

// Double precision to rounding of the sums; single precision rounds 27 terms at 6e-8.
TEST_P(Transfers, scatters_mass_momentum_and_force_as_defined) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) {
    compare<double, GpuDevice, Linear>(1e-12);
    compare<double, GpuDevice, Quadratic>(1e-12);
    compare<double, GpuDevice, Gimp>(1e-12);
    compare<float, GpuDevice, Linear>(1e-5);
    compare<float, GpuDevice, Quadratic>(1e-5);
    compare<float, GpuDevice, Gimp>(1e-5);
    return;
  }
#endif
  compare<double, CpuDevice, Linear>(1e-12);
  compare<double, CpuDevice, Quadratic>(1e-12);
  compare<double, CpuDevice, Gimp>(1e-12);
  compare<float, CpuDevice, Linear>(1e-5);
  compare<float, CpuDevice, Quadratic>(1e-5);
  compare<float, CpuDevice, Gimp>(1e-5);
}

TEST_P(Transfers, gathers_a_linear_field_exactly) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) {
    gather_linear_field<double, GpuDevice, Linear>(1e-12);
    gather_linear_field<double, GpuDevice, Quadratic>(1e-12);
    gather_linear_field<double, GpuDevice, Gimp>(1e-12);
    gather_linear_field<float, GpuDevice, Quadratic>(1e-5);
    gather_linear_field<float, GpuDevice, Gimp>(1e-5);
    return;
  }
#endif
  gather_linear_field<double, CpuDevice, Linear>(1e-12);
  gather_linear_field<double, CpuDevice, Quadratic>(1e-12);
  gather_linear_field<double, CpuDevice, Gimp>(1e-12);
  gather_linear_field<float, CpuDevice, Quadratic>(1e-5);
  gather_linear_field<float, CpuDevice, Gimp>(1e-5);
}

TALUS_IN_EACH_PLACE(Transfers);

}  // namespace
}  // namespace talus::solver::testing
