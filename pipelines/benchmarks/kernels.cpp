// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipelines/benchmarks/kernels.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "common/error.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/device.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::benchmarks {
namespace {

using namespace solver;

/// Velocity of the block [m/s]: some metres in the time of a run. With hats it rests, and in explicit steps weighs
/// nothing: where points cross cells, nodes with next to no mass throw them away.
struct Way {
  double x, y;
};
Way way_of(ShapeKind shape) { return shape == ShapeKind::linear ? Way{0, 0} : Way{0.3, 0.2}; }
constexpr double density = 2000;  // [kg/m3]

/// The seeds of a block of `wide` x `wide` x `high` cells that stands on the terrain, `margin` cells from the edges of
/// the map: 8 points to a cell, by number from the lowest layer on.
void place_seeds(int margin, int wide, int high, ParticleState& s) {
  const auto count = static_cast<std::size_t>(8) * static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide) *
                     static_cast<std::size_t>(high);
  for (auto* list : {&s.cell[0], &s.cell[1], &s.cell[2], &s.id}) list->reserve(count);
  for (int k = 0; k < 2 * high; ++k)
    for (int j = 0; j < 2 * wide; ++j)
      for (int i = 0; i < 2 * wide; ++i) {
        const double at[3] = {margin + 0.25 + 0.5 * i, margin + 0.25 + 0.5 * j, 0.25 + 0.5 * k};
        for (int a = 0; a < 3; ++a) {
          const double nearest = std::floor(at[a] + 0.5);
          s.cell[a].push_back(static_cast<int>(nearest));
          s.offset[a].push_back(at[a] - nearest);
        }
        s.id.push_back(static_cast<int>(s.id.size()));
      }
}

/// A block of sand 8 points to a cell, four times as wide as high, on level ground without friction, on its way.
Scene block(double points, const SolveOptions& options) {
  const int high = std::max(4, static_cast<int>(std::lround(std::cbrt(points / 8 / 16)))),
            wide = std::max(4, static_cast<int>(std::lround(std::sqrt(points / 8 / high))));
  constexpr int margin = 12;
  Scene scene;
  GridShape& shape = scene.grid;
  shape.columns = shape.rows = wide + 2 * margin;
  shape.spacing = shape.layer_height = 1;
  shape.quadratic = options.shape == ShapeKind::quadratic;
  shape.lowest_weighed = options.integrator == Integrator::explicit_ ? 0.1 : 0.01;  // as make_scene
  shape.terrain.assign(static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows), 0.0);
  scene.terrain = make_terrain_tables(shape);
  scene.map = {shape.columns, shape.rows, 0, 0, 1, ""};
  ParticleState& s = scene.points;
  place_seeds(margin, wide, high, s);
  const auto constant = [&](double value) { return std::vector<double>(s.id.size(), value); };
  s.velocity[0] = constant(options.initial_velocity[0]);
  s.velocity[1] = constant(options.initial_velocity[1]);
  s.velocity[2] = constant(0);
  for (int a = 0; a < 3; ++a) {
    s.extent[a] = constant(0.5);
    s.acceleration[a] = constant(0);
  }
  for (auto& list : s.affine) list = constant(0);
  for (auto& list : s.elastic) list = constant(0);
  s.log_volume = s.plastic_log_volume = s.plastic_shear = constant(0);
  s.volume = constant(0.125);
  s.release.assign(s.id.size(), 0);
  s.material.assign(s.id.size(), 0);
  s.load.assign(s.id.size(), -1);
  return scene;
}

SolveOptions options_for(const KernelSetting& k) {
  SolveOptions o;
  o.integrator = Integrator::explicit_;
  o.shape = k.shape;
  o.precision = k.precision;
  o.material.density = density;
  o.material.youngs_modulus = 1e7;
  o.material.cohesion = 1e6;  // the block stays together
  o.material.tension_cutoff = 1e5;
  o.base.law = FrictionLaw::none;
  o.initial_velocity = {way_of(k.shape).x, way_of(k.shape).y, 0};
  if (k.shape == ShapeKind::linear && !k.newmark) o.gravity = {0, 0, 0};
  if (k.newmark) {
    o.integrator = Integrator::newmark;
    o.implicit.step = 0.05;  // about 5 CFL steps
    o.implicit.newmark = {0.5, 1};
    o.implicit.newton_tolerance = 1e-4;
    o.implicit.linear_tolerance = 1e-3;
  }
  return o;
}

/// Steps taken, at least so many.
struct Taken {
  int steps = 0, newton = 0, linear = 0;
};
Taken take(Solver& solver, int steps) {
  Taken taken;
  const auto first = solver.clock().step;
  while (taken.steps < steps) {
    const BatchReport batch = solver.advance();
    if (batch.clock.alarms.halt == failed)
      throw NumericalError({fmt::format("point {} of the block lost its state in step {}",
                                        batch.clock.alarms.failed_point, batch.clock.step),
                            "the steps timed are not those of a body that holds together", ""});
    taken.newton += batch.stats.newton;
    taken.linear += batch.stats.linear;
    taken.steps = static_cast<int>(batch.clock.step - first);
  }
  return taken;
}

/// Steps that suffice to warm up, and to guess how long one takes.
int few_of(const KernelSetting& k) { return k.newmark ? 3 : 20; }

/// Three rounds of about 0.3 s each, and the median of their times.
void time_steps(const KernelSetting& k, Solver& solver, KernelRun& run) {
  const int few = few_of(k);
  take(solver, few);  // storage, first launches
  using WallClock = std::chrono::steady_clock;
  const auto timed = [&](int steps) {
    const auto begun = WallClock::now();
    const Taken taken = take(solver, steps);
    run.steps = taken.steps;
    return std::chrono::duration<double>(WallClock::now() - begun).count() / taken.steps;
  };
  const double guess = timed(few);
  const int steps = std::clamp(static_cast<int>(0.3 / guess), few, k.newmark ? 20 : 2000);
  std::vector<double> rounds;
  for (int round = 0; round < 3; ++round) rounds.push_back(timed(steps));
  std::sort(rounds.begin(), rounds.end());
  run.step_seconds = rounds[1];
}

/// The block keeps its momentum.
void check_momentum(const KernelSetting& k, const Energies& e, KernelRun& run) {
  const double mass = run.points * 0.125 * density;
  run.check = std::hypot(e.momentum.x / mass - way_of(k.shape).x, e.momentum.y / mass - way_of(k.shape).y) / 0.36;
  // Rounding; Newton's tolerance of 1e-4 in some ten steps.
  run.pass = run.check < (k.newmark ? 2e-3 : k.precision == Precision::double_ ? 1e-9 : 1e-3);
}

/// Phases and kernels, in rounds of their own: to measure them takes time.
void profile_steps(const KernelSetting& k, Solver& solver, Profile& profile, KernelRun& run) {
  const auto profiled = [&](bool kernels) {
    profile.clear();
    profile.turn_on(kernels);
    const Taken taken = take(solver, kernels ? few_of(k) : 20);
    profile.turn_off();
    return taken;
  };
  const auto keep_phases = [&](int over) {
    for (const auto& phase : profile.phases())
      if (phase.seconds > 0) run.phases.emplace_back(phase.name, phase.seconds / over);
  };
  if (k.newmark) {  // whose phases hold many kernels each: marks around every one would be in the way
    const Taken taken = profiled(false);
    run.newton_iterations = static_cast<double>(taken.newton) / taken.steps;
    run.cg_iterations = static_cast<double>(taken.linear) / taken.steps;
    keep_phases(taken.steps);
  }
  const int steps = profiled(true).steps;
  if (!k.newmark) keep_phases(steps);
  for (const auto& kernel : profile.kernels())
    run.kernels.push_back({kernel.name, kernel.seconds / steps, kernel.bytes / steps});
  std::sort(run.kernels.begin(), run.kernels.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
}

std::string method_of(const KernelSetting& k) { return k.newmark ? "newmark" : "explicit"; }
std::string shape_of(const KernelSetting& k) { return k.shape == ShapeKind::linear ? "linear" : "quadratic"; }
std::string precision_of(const KernelSetting& k) { return k.precision == Precision::double_ ? "double" : "single"; }

}  // namespace

double KernelRun::seconds_of(const std::string& phase) const {
  const auto found = std::ranges::find(phases, phase, [](const auto& p) { return p.first; });
  return found == phases.end() ? 0 : found->second;
}

double KernelRun::newton_seconds() const {
  if (!(newton_iterations > 0)) return 0;
  double sum = 0;
  for (const char* phase :
       {"stress and tangent", "residual and contact", "operator and preconditioner", "conjugate gradients"})
    sum += seconds_of(phase);
  return sum / newton_iterations;
}

std::string name_of(const KernelSetting& k) {
  return fmt::format("{} {} {}", method_of(k), shape_of(k), precision_of(k));
}

KernelRun time_kernels(const KernelSetting& k, On on) {
  const SolveOptions options = options_for(k);
  const AnyDevice device = make_device(on);
  const auto solver = [&] {
    const Scene scene = block(k.points, options);
    return make_solver(scene, options, device);
  }();
  solver->set_next_event(1e9);
  KernelRun run;
  run.method = method_of(k);
  run.shape = shape_of(k);
  run.precision = precision_of(k);
  run.place = device.is_gpu() ? device.gpu().name() : "CPU";
  run.points = solver->particle_count();
  time_steps(k, *solver, run);
  run.bytes = static_cast<double>(solver->bytes());
  check_momentum(k, solver->energies(), run);
  for (const auto& [owner, bytes] : solver->memory()) run.memory.emplace_back(owner, static_cast<double>(bytes));
  profile_steps(k, *solver, device.profile(), run);
  return run;
}

}  // namespace talus::benchmarks
