// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of a step (T17c); what goes from step to step: their length, and when iterations are given up.
#include <cmath>
#include <random>

#include "solver/implicit/implicit_step.hpp"
#include "solver/implicit/newton.hpp"
#include "solver/implicit/tangent_system.hpp"
#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

/// The step of a block on a slope.
struct StepBench : PartsBench {
  ImplicitStep<double, CpuDevice, Shape> step;

  explicit StepBench(const SolveOptions& o) : PartsBench(o), step(parts(), {device, settings.common.bed, scene.bed}) {
    step.group({});
    step.begin({.start = 0, .step = settings.implicit.step});
  }

  /// Contacts decided on until none changes.
  Unbalanced settle() {
    step.measure(Linearisation::consistent);
    Unbalanced now = step.residual(Contacts::decided);
    for (int i = 0; now.changed && i < 10; ++i) {
      step.measure(Linearisation::consistent);
      now = step.residual(Contacts::decided);
    }
    EXPECT_FALSE(now.changed);
    return now;
  }
};

TEST(ImplicitStep, has_a_linear_system_that_is_the_derivative_of_its_residual) {
  for (const auto integrator : {Integrator::newmark, Integrator::quasi_static}) {
    for (const bool b_bar : {false, true}) {
      SolveOptions o = options_of(integrator);
      o.implicit.b_bar = b_bar;
      // A sheet that slides without inertia goes far beyond the slip over which its friction turns.
      if (integrator == Integrator::quasi_static) o.base.law = FrictionLaw::stick;
      StepBench bench(o);
      const double before = bench.settle().force;
      ASSERT_GT(before, 1);
      ASSERT_TRUE(bench.step.solve(1e-12).converged);
      // With a small share of the change, that share of the residual is gone.
      constexpr double share = 1e-3;
      bench.step.begin_search();
      bench.step.apply_change(share);
      bench.step.measure(Linearisation::consistent);
      const Unbalanced after = bench.step.residual(Contacts::kept);
      EXPECT_NEAR(after.force / before, 1 - share, 0.02 * share) << name_of(o.shape) << (b_bar ? ", B-bar" : "");
      EXPECT_NEAR(after.along / after.downhill, 1 - share, 0.02 * share);
      bench.step.return_to_start();
      bench.step.measure(Linearisation::consistent);
      EXPECT_DOUBLE_EQ(bench.step.residual(Contacts::kept).force, before);
    }
  }
}

TEST(ImplicitStep, is_solved_by_newtons_method) {
  SolveOptions o = options_of(Integrator::newmark);
  StepBench bench(o);
  const NewtonReport report = bench.step.solve();
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual, scheme_of(o).tolerance);
  EXPECT_LT(bench.step.farthest_motion().share, 1);
  EXPECT_GT(bench.step.farthest_motion().length, 0);
}

TEST(ImplicitStep, counts_its_memory_by_name) {
  StepBench bench(options_of(Integrator::newmark));
  std::size_t total = 0;
  bool nodes = false;
  bench.step.list_memory([&](const std::string& name, std::size_t bytes) {
    total += bytes;
    nodes = nodes || (name == "nodes" && bytes > 0);
  });
  EXPECT_TRUE(nodes);
  EXPECT_GT(total, static_cast<std::size_t>(bench.points.count()) * sizeof(double));
}

/// The solution of the system of a body on its bed for a push that is the same for every solver [m].
std::vector<Vec3<double>> solution(LinearSolver solver) {
  SolveOptions o = options_of(Integrator::newmark);
  o.base.law = FrictionLaw::stick;
  o.implicit.linear_solver = solver;
  PartsBench bench(o);
  const auto parts = bench.parts();
  NodeFields<CpuDevice> nodes(bench.device);
  nodes.resize(bench.grid.nodes());
  const auto count = static_cast<std::size_t>(nodes.count);
  double pull = 0;
  ContactSet<double, CpuDevice, PartsBench::Shape> contacts(
      parts, nodes, {bench.device, bench.settings.common.bed, bench.scene.bed}, &pull);
  TangentSystem<double, CpuDevice, PartsBench::Shape> system(parts, nodes, contacts);
  const NewmarkScheme scheme{.dynamic = true, .step = 0.01};
  system.group();
  contacts.resize();
  system.begin(scheme);
  scatter_points(
      bench.device, bench.points.count(), bench.grid.groups(),
      ScatterInertia<double, PartsBench::Shape>{
          {bench.grid.view(), bench.points.view()}, bench.materials, false, true, nullptr, nodes.arrays(true)});
  contacts.begin(scheme, {}, {0, 0, -10});
  nodes.u.fill_zero();
  system.measure(Linearisation::consistent);
  const auto freed = nodes.freed.download();
  std::vector<Vec3<double>> push(count);
  for (std::size_t n = 0; n < count; ++n)
    push[n] =
        freed[n] * Vec3<double>{std::sin(1.0 * static_cast<double>(n)), 1, std::cos(2.0 * static_cast<double>(n))};
  NodeVector<CpuDevice> b(bench.device), x(bench.device);
  b.upload(push);
  x.upload(std::vector<Vec3<double>>(count));
  EXPECT_TRUE(system.solve(b, x, 1e-10).converged);
  return x.download();
}

TEST(TangentSystem, has_one_solution_by_any_solver) {
  const auto expected = solution(LinearSolver::cholesky);
  double size = 0;
  for (const Vec3<double>& v : expected) size += dot(v, v);
  EXPECT_GT(size, 0);
  const auto x = solution(LinearSolver::pcg);
  double off = 0;
  for (std::size_t n = 0; n < x.size(); ++n) off += dot(x[n] - expected[n], x[n] - expected[n]);
  // Conjugate gradients take tangents that are rounded to single precision, 6e-8 of them.
  EXPECT_LT(std::sqrt(off / size), 1e-5);
}

SolveOptions one_solve() {
  SolveOptions o = options_of(Integrator::newmark);
  o.material.model = MaterialModel::drucker_prager;
  o.material.friction_angle = 30;
  o.implicit.newton_iterations = 1;
  return o;
}

/// The block with every point's stress on the cone, where a step has left it, and moving as a swirl that loads some of
/// them and unloads others. `share`: of each stress, by which rounding has moved it up or down.
struct YieldedBench : PartsBench {
  explicit YieldedBench(const SolveOptions& o, double share = 0) : PartsBench(o) {
    ParticleState s = points.download();
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto column = [&](double size) { return Vec3<double>{size * u(engine), size * u(engine), size * u(engine)}; };
    for (std::size_t p = 0; p < s.size(); ++p) {
      MaterialState<double> state;
      while (!(state.plastic_shear > 0)) {
        state = {.elastic = {}, .log_volume = -0.02};
        advance_material(materials.list[0], {column(0.01), column(0.01), column(0.01)}, 0.01, state);
        if (!(state.log_volume < -0.01)) state.plastic_shear = 0;
      }
      const double moved = 1 + (u(engine) > 0 ? share : -share);
      const Sym3<double>& e = state.elastic;
      const double strain[6] = {e.xx, e.yy, e.zz, e.xy, e.yz, e.xz};
      for (std::size_t q = 0; q < 6; ++q) s.elastic[q][p] = strain[q] * moved;
      s.log_volume[p] = state.log_volume;
      s.velocity[0][p] = std::sin(0.9 * s.cell[2][p] + 0.5 * s.cell[1][p]);
      s.velocity[1][p] = std::cos(0.8 * s.cell[0][p]);
      s.velocity[2][p] = 0.5 * std::sin(0.7 * s.cell[0][p]);
    }
    points.upload(s);
    grid.fit(points, 0);
  }
};

/// The displacement of the farthest point in one solve [m].
double way_of_one_solve(double share) {
  YieldedBench bench(one_solve(), share);
  ImplicitStep<double, CpuDevice, PartsBench::Shape> step(bench.parts(),
                                                          {bench.device, bench.settings.common.bed, bench.scene.bed});
  step.group({});
  step.begin({.start = 0, .step = 0.05});
  EXPECT_TRUE(step.solve().converged);
  return step.farthest_motion().length;
}

TEST(StartAtYield, one_solve_does_not_hang_on_rounding) {
  // Stresses moved by 1e-14 move the solution by what the linear solver leaves, 1e-8 of its right-hand side.
  const double way = way_of_one_solve(0);
  ASSERT_GT(way, 1e-3);
  EXPECT_NEAR(way_of_one_solve(1e-14), way, 1e-6 * way) << "at " << way;
}

/// Forces [N] and their changes along a way of the nodes, from the stresses and tangents of the bench's points.
class ForcesAhead {
 public:
  explicit ForcesAhead(YieldedBench& bench) : bench_(bench), parts_(bench.parts()) {
    mass_.upload(std::vector<double>(nodes(), 1e6));  // so that no node is light, and none on springs
    stresses_.group();
    stresses_.begin(0.01);
  }
  std::size_t nodes() const { return static_cast<std::size_t>(bench_.grid.nodes()); }

  /// The internal force for the displacement u.
  std::vector<Vec3<double>> at(const std::vector<Vec3<double>>& u) {
    u_.upload(u);
    sums_.upload(std::vector<Vec3<double>>(nodes()));
    stresses_.measure(u_, sums_, false, false);
    return sums_.download();
  }
  /// What the tangent at rest, with `way` ahead, makes of that way.
  std::vector<Vec3<double>> along(const std::vector<Vec3<double>>& way) {
    using Product = TangentTimes<double, PartsBench::Shape>;
    NodeVector<CpuDevice> ahead(bench_.device);
    ahead.upload(way);
    u_.upload(std::vector<Vec3<double>>(nodes()));
    sums_.upload(std::vector<Vec3<double>>(nodes()));
    stresses_.measure(u_, sums_, true, false, ahead.data());
    sums_.fill_zero();
    scatter_points(bench_.device, bench_.points.count(), bench_.grid.groups(),
                   ScatterForces<double, PartsBench::Shape, Product>{{bench_.grid.view(), bench_.points.view()},
                                                                     Product{stresses_.view().tangents, ahead.data()},
                                                                     sums_.data()});
    return sums_.download();
  }

 private:
  YieldedBench& bench_;
  StepParts<double, CpuDevice, PartsBench::Shape> parts_;
  Buffer<double, CpuDevice> mass_{bench_.device};
  ParticleStresses<double, CpuDevice, PartsBench::Shape> stresses_{parts_, mass_};
  NodeVector<CpuDevice> u_{bench_.device}, sums_{bench_.device};
};

/// Shear of the layers along the slope of 0.6 and across it. It keeps the volume, and so the frozen yield stress.
std::vector<Vec3<double>> shear_of_layers(const YieldedBench& bench) {
  std::vector<Vec3<double>> way(static_cast<std::size_t>(bench.grid.nodes()));
  for (const BlockSlot& slot : slots_of(bench.grid)) {
    for (int n = 0; n < slot.layers * block_columns; ++n) {
      const double layer = slot.first_layer + n / block_columns, along = 0.01 * std::sin(1.3 * layer);
      way[static_cast<std::size_t>(slot.ground + slot.first_layer * block_columns + n)] = {
          along, 0.01 * std::cos(0.7 * layer), -0.6 * along};
    }
  }
  return way;
}

TEST(StartAtYield, tangent_is_the_derivative_of_the_forces_along_the_way_ahead) {
  YieldedBench bench(one_solve());
  ForcesAhead forces(bench);
  const std::vector<Vec3<double>> way = shear_of_layers(bench);
  std::vector<Vec3<double>> little(way.size());
  constexpr double share = 1e-6;  // of strains of some 1e-2
  for (std::size_t n = 0; n < way.size(); ++n) little[n] = way[n] * share;
  const auto product = forces.along(way), here = forces.at(std::vector<Vec3<double>>(way.size())),
             there = forces.at(little);
  double off = 0, size = 0;
  for (std::size_t n = 0; n < way.size(); ++n) {
    const Vec3<double> change = (there[n] - here[n]) * (1 / share), error = change - product[n];
    off += dot(error, error);
    size += dot(change, change);
  }
  // The forces are curved by the share over what stresses are of stiffness, 1e-6 / 1e-2.
  EXPECT_LT(std::sqrt(off / size), 1e-3);
}

constexpr int most_iterations = 30, few = 4;

TEST(StepLength, never_steps_over_an_event) {
  const StepLength length(1, most_iterations);
  EXPECT_EQ(length.next(10), 1);
  EXPECT_EQ(length.next(1.5), 0.75) << "two even steps rather than a full one and a sliver";
  EXPECT_EQ(length.next(0.5), 0.5);
  EXPECT_EQ(length.next(1 + 1e-12), 1 + 1e-12);
}

TEST(StepLength, a_short_step_before_an_event_leaves_the_plan_as_it_was) {
  StepLength length(1, most_iterations);
  length.accept(0.25, few, 0.1);
  EXPECT_EQ(length.next(10), 1);
}

TEST(StepLength, grows_with_few_iterations_stays_with_some_and_shrinks_with_many) {
  StepLength length(1, most_iterations);
  EXPECT_EQ(length.refuse(1, 0), 0.5);
  EXPECT_EQ(length.refuse(0.5, 0), 0.25);
  length.accept(0.25, 12, 0);
  EXPECT_EQ(length.next(10), 0.25);
  length.accept(0.25, few, 0);
  EXPECT_EQ(length.next(10), 0.375);
  length.accept(0.375, 25, 0);
  EXPECT_EQ(length.next(10), 0.7 * 0.375);
}

TEST(StepLength, of_one_linear_solve_grows_after_each) {
  StepLength length(1, 1);
  length.refuse(1, 0);
  length.accept(0.5, 1, 0);
  EXPECT_EQ(length.next(10), 0.75);
}

TEST(StepLength, foresees_the_way_of_the_farthest_point) {
  StepLength length(1, most_iterations);
  EXPECT_NEAR(length.refuse(1, 4), 0.2, 1e-12) << "0.8 of the way, not half of the step";
  length.accept(0.2, few, 0.9);
  EXPECT_NEAR(length.next(10), 0.2 * 0.8 / 0.9, 1e-12);
}

/// Attempts at steps of which those longer than `limit(time)` fail.
struct Attempts {
  int accepted = 0, failed = 0;
  double share = 0;  ///< of the limit that the steps took, in the mean
};
template <class Limit>
Attempts attempts(const Limit& limit, bool of_motion = false) {
  StepLength length(1, most_iterations);
  Attempts count;
  double time = 0;
  while (count.accepted < 2000) {
    double step = length.next(1e9);
    const auto motion = [&] { return of_motion ? step / limit(time) : 0.0; };
    while (step > limit(time)) {
      ++count.failed;
      step = length.refuse(step, motion());
    }
    length.accept(step, few, motion());
    ++count.accepted;
    count.share += step / limit(time);
    time += step;
  }
  count.share /= count.accepted;
  return count;
}

TEST(StepLength, wastes_less_than_a_twentieth_of_its_attempts_on_a_limit_that_it_does_not_know) {
  for (const double limit : {0.9, 0.5, 0.037, 0.002}) {
    const Attempts still = attempts([&](double) { return limit; });
    EXPECT_LT(still.failed, 0.05 * still.accepted) << limit;
    EXPECT_GT(still.share, 0.7) << limit;
  }
  const Attempts moving = attempts([](double time) { return 0.02 * std::exp(std::sin(0.2 * time)); });
  EXPECT_LT(moving.failed, 0.05 * moving.accepted);
  EXPECT_GT(moving.share, 0.6);
  const Attempts far = attempts([](double time) { return 0.1 / (1 + 0.1 * time); }, true);
  EXPECT_LT(far.failed, 0.01 * far.accepted) << "a limit on the way is foreseen";
}

/// The iteration at which a step with this residual is given up; -1: none of a hundred.
template <class Residual>
int given_up_at(int patience, const Residual& residual) {
  Stall stall(patience);
  for (int n = 0; n < 100; ++n)
    if (stall.gives_up(residual(n))) return n;
  return -1;
}

TEST(Stall, gives_up_when_the_residual_stays) {
  EXPECT_EQ(given_up_at(7, [](int) { return 0.01; }), 7);
  // A first fall, then nothing: so many iterations after the last halving. Growth is none.
  EXPECT_EQ(given_up_at(7, [](int n) { return n < 5 ? std::pow(0.4, n) : 0.05 * n; }), 4 + 7);
}

TEST(Stall, waits_while_the_residual_halves_now_and_then) {
  EXPECT_EQ(given_up_at(7, [](int n) { return std::pow(0.9, n); }), -1) << "it halves in 6.6 iterations";
  EXPECT_EQ(given_up_at(6, [](int n) { return std::pow(0.9, n); }), 6);
}

TEST(Stall, never_gives_up_unasked) {
  EXPECT_EQ(given_up_at(0, [](int) { return 0.01; }), -1);
}

TEST(FrictionSmoothing, widens_by_tens_and_narrows_by_halves) {
  FrictionSmoothing s{.smooths = true, .gravity_way = 2};
  EXPECT_EQ(s.slip(), 2e-5);
  EXPECT_DOUBLE_EQ(s.head_start(), 2e-3);
  int times = 0;
  while (s.widen()) ++times;
  EXPECT_EQ(times, 4);
  EXPECT_EQ(s.width, FrictionSmoothing::widest);
  EXPECT_TRUE(s.too_wide_for(0.1));
  EXPECT_FALSE(s.too_wide_for(10));
  s.narrow_after(100);
  EXPECT_EQ(s.width, FrictionSmoothing::widest) << "that step did not converge well";
  s.narrow_after(3);
  EXPECT_EQ(s.width, 0.5 * FrictionSmoothing::widest);
  for (int i = 0; i < 9; ++i) s.narrow();
  EXPECT_EQ(s.width, FrictionSmoothing::narrowest);
  EXPECT_FALSE(s.too_wide_for(0));
  s.smooths = false;
  EXPECT_FALSE(s.widen());
}

}  // namespace
}  // namespace talus::solver::testing
