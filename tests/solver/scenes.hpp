// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Small scenes for the solver's tests, and the places they run in.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

#include "solver/grid/sparse_grid.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/on.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver::testing {

inline constexpr double degree = std::numbers::pi / 180;  ///< [rad]

/// Of a rigid block on an incline under Coulomb's friction, down it [m/s2]; angles in degrees.
inline double sliding_acceleration(double slope, double friction) {
  return 9.81 * (std::sin(slope * degree) - std::tan(friction * degree) * std::cos(slope * degree));
}

struct Corner {
  double x = 0, y = 0;  // [m]
};

/// A flat or tilted ground under columns x rows cells from the south-western corner {x, y} on.
inline Domain ground(int columns, int rows, double cell, double layer_height,
                     const std::function<double(double, double)>& elevation, Corner corner = {}) {
  Domain d;
  d.grid = {columns, rows, corner.x, corner.y, cell, ""};
  d.layer_height = layer_height;
  d.terrain = d.before = d.release_thickness = {d.grid, std::vector<double>(d.grid.count(), 0.0)};
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) d.terrain.at(i, j) = d.before.at(i, j) = elevation(d.grid.x(i), d.grid.y(j));
  d.release_names = {"body"};
  return d;
}

/// The elevation of level ground [m].
inline double flat(double, double) { return 0; }

/// The recipe's name of shape functions.
template <class Shape>
inline constexpr ShapeKind kind_of = Shape::averaged ? ShapeKind::gimp
                                     : Shape::spline ? ShapeKind::quadratic
                                                     : ShapeKind::linear;

inline const char* name_of(ShapeKind shape) {
  return shape == ShapeKind::linear ? "linear" : shape == ShapeKind::gimp ? "gimp" : "quadratic";
}

/// The steps that flows take, and all that have inertia.
inline constexpr Integrator flow_integrators[] = {Integrator::explicit_, Integrator::column_implicit};
inline constexpr Integrator moving_integrators[] = {Integrator::explicit_, Integrator::column_implicit,
                                                    Integrator::newmark};

inline const char* name_of(Integrator i) {
  return i == Integrator::newmark ? "newmark" : i == Integrator::column_implicit ? "column-implicit" : "explicit";
}

struct Box {
  double x0, x1, y0, y1, bottom, top;  // [m]; bottom and top above the ground
};

/// first, first + step, ... below `end`, as adding makes them.
inline std::vector<double> lattice(double first, double end, double step) {
  std::vector<double> result;
  while (first < end) {
    result.push_back(first);
    first += step;
  }
  return result;
}

/// Points on a regular lattice, `across` per cell in x and y and `up` per layer, filling a box.
inline void fill(Domain& d, const Box& box, int across = 2, int up = 2) {
  const double dx = d.grid.cell / across, dz = d.layer_height / up;
  for (const double h : lattice(box.bottom + dz / 2, box.top, dz)) {
    for (const double y : lattice(box.y0 + dx / 2, box.y1, dx)) {
      for (const double x : lattice(box.x0 + dx / 2, box.x1, dx)) {
        d.points.x.push_back(x);
        d.points.y.push_back(y);
        d.points.height.push_back(h);
        d.points.volume.push_back(dx * dx * dz);
        d.points.extent_x.push_back(dx);
        d.points.extent_y.push_back(dx);
        d.points.release.push_back(0);
      }
    }
  }
}

/// The same domain with points in a box.
inline Domain filled(Domain d, const Box& box, int across = 2, int up = 2) {
  fill(d, box, across, up);
  return d;
}

/// The released thickness [m] in columns and rows from the first to before the last.
inline void release(Domain& d, std::array<int, 2> columns, std::array<int, 2> rows, double thickness) {
  for (int row = rows[0]; row < rows[1]; ++row)
    for (int column = columns[0]; column < columns[1]; ++column) d.release_thickness.at(column, row) = thickness;
}

inline double total(const Energies& e) { return e.kinetic + e.potential + e.elastic; }

/// All steps half as long as the CFL step.
inline SolveOptions stepping_by(Integrator integrator) {
  SolveOptions o;
  o.integrator = integrator;
  o.cfl = default_cfl;
  return o;
}

/// Hencky's law with a modulus of elasticity [Pa].
inline SolveOptions elastic_options(double youngs_modulus, Integrator integrator = Integrator::explicit_) {
  SolveOptions o = stepping_by(integrator);
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = youngs_modulus;
  return o;
}

/// Upright rollers about a square.
inline std::vector<WallOptions> rollers(double from, double to) {
  std::vector<WallOptions> walls;
  for (const Axis axis : {Axis::x, Axis::y}) {
    walls.push_back({axis, from, Side::above});
    walls.push_back({axis, to, Side::below});
  }
  return walls;
}

/// Calls f(i, j, k, n) for every stored node n of a grid whose blocks of columns are stored in these slots.
template <class Real, class F>
void for_stored_nodes(const GridView<Real>& grid, const std::vector<BlockSlot>& slots, F&& f) {
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const BlockSlot& slot = slots[static_cast<std::size_t>((j >> 2) * grid.block_columns_x + (i >> 2))];
      for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k)
        f(i, j, k, static_cast<std::size_t>(GridView<Real>::node(slot, i, j, k)));
    }
  }
}

/// Where the blocks of columns are stored.
template <class Real, class Device>
std::vector<BlockSlot> slots_of(const SparseGrid<Real, Device>& grid) {
  const auto view = grid.view();
  const auto count = static_cast<std::size_t>(((view.columns + 3) / 4) * ((view.rows + 3) / 4));
  std::vector<BlockSlot> slots(count);
  copy_to_host(grid.device(), slots.data(), view.slots, count * sizeof(BlockSlot));
  return slots;
}

/// A GPU that is not there skips a test aloud, and fails it where one was promised. Where it is there, the test's
/// report says that it was used (tools/record-gpu-tests.py).
inline void need_gpu() {
  if (gpu_available()) return ::testing::Test::RecordProperty("on", "gpu");
  if (std::getenv("TALUS_REQUIRE_GPU") != nullptr) FAIL() << "TALUS_REQUIRE_GPU is set, but no GPU can be used";
  GTEST_SKIP() << "no GPU on this machine: the same test ran on the CPU";
}

/// Where a test runs.
class InEachPlace : public ::testing::TestWithParam<On> {
 protected:
  void SetUp() override {
    if (GetParam() == On::gpu) need_gpu();
  }
};

/// A test that is handed a device of the place that it runs in.
class OnEachDevice : public InEachPlace {
 protected:
  /// The method calls body(device).
  template <class Body>
  static void on_device(Body&& body) {
    if (GetParam() == On::cpu) body(CpuDevice::make());
#if TALUS_FOR_GPU
    if (GetParam() == On::gpu) body(GpuDevice::make());
#endif
  }
};

inline std::string place_name(const ::testing::TestParamInfo<On>& info) {
  return info.param == On::gpu ? "gpu" : "cpu";
}

#define TALUS_IN_EACH_PLACE(suite) \
  INSTANTIATE_TEST_SUITE_P(places, suite, ::testing::Values(On::cpu, On::gpu), place_name)

/// The state of a scene at the start, with points of its own.
inline SolverState first_state(const Scene& scene, const IntegratorSettings& settings) {
  SolverState state = solver::first_state(scene, settings, scene.points);
  state.points = scene.points;
  state.seeds = nullptr;
  return state;
}

/// A solver on a new device.
inline std::unique_ptr<Solver> make_solver(const Scene& scene, const SolveOptions& options, On on) {
  return solver::make_solver(scene, options, make_device(on));
}
inline std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolveOptions& options, On on,
                                             const SolverState& state) {
  return solver::resume_solver(scene, options, make_device(on), state);
}

/// Step to a time; `look` is called with the report of each batch.
template <class Look>
void run_to(Solver& solver, double time, Look&& look) {
  solver.set_next_event(time);
  for (BatchReport batch; batch.clock.alarms.halt != at_event;) {
    batch = solver.advance();
    look(batch);
    if (batch.clock.alarms.halt != failed) continue;
    ADD_FAILURE() << "point " << batch.clock.alarms.failed_point << " failed at t = " << batch.clock.time;
    return;
  }
}

/// Step to a time; returns the number of sorts on the way.
inline int run_to(Solver& solver, double time) {
  int sorts = 0;
  run_to(solver, time, [&](const BatchReport& batch) { sorts += batch.sorted ? 1 : 0; });
  return sorts;
}

struct Centre {
  double x = 0, y = 0, z = 0, speed = 0;
};

/// Volume-weighted centre and mean speed of the points.
inline Centre centre(const Solver& solver, const Scene& scene) {
  const ParticleState s = solver.state().points;
  const auto x = positions(scene, s);
  Centre c;
  double volume = 0, vx = 0, vy = 0, vz = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double v = s.volume[p];
    volume += v;
    c.x += v * x[p][0];
    c.y += v * x[p][1];
    c.z += v * x[p][2];
    vx += v * s.velocity[0][p];
    vy += v * s.velocity[1][p];
    vz += v * s.velocity[2][p];
  }
  return {c.x / volume, c.y / volume, c.z / volume, std::sqrt(vx * vx + vy * vy + vz * vz) / volume};
}

/// The share of a deposit that lies elsewhere than that of `reference`.
inline double share_elsewhere(const std::vector<double>& thickness, const std::vector<double>& reference) {
  double moved = 0, all = 0;
  for (std::size_t n = 0; n < reference.size(); ++n) {
    moved += 0.5 * std::abs(thickness[n] - reference[n]);
    all += reference[n];
  }
  return moved / all;
}

/// The mean velocity down a slope [deg] that falls eastwards, of what is within 4 m of the centre [m/s].
inline double speed_inside(const Solver& solver, const Scene& scene, double slope) {
  const double angle = slope * std::numbers::pi / 180;
  const ParticleState s = solver.state().points;
  const auto x = positions(scene, s);
  const double middle = centre(solver, scene).x;
  double sum = 0, volume = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    if (std::abs(x[p][0] - middle) > 4) continue;
    sum += s.volume[p] * (s.velocity[0][p] * std::cos(angle) - s.velocity[2][p] * std::sin(angle));
    volume += s.volume[p];
  }
  return sum / volume;
}

/// A run of a scene on a new device, until a time.
struct SceneRun {
  Scene scene;
  std::unique_ptr<Solver> solver;
  Centre first;  ///< as it begins
  SceneRun(const Domain& d, const SolveOptions& o, On on, double until = 0)
      : scene(make_scene(d, o)), solver(make_solver(scene, o, on)), first(now()) {
    if (until > 0) run_to(*solver, until);
  }
  Centre now() const { return centre(*solver, scene); }
  Centre at(double time) const {
    run_to(*solver, time);
    return now();
  }
};

}  // namespace talus::solver::testing
