// Implicit steps against closed forms, explicit steps and one another.
#include <numbers>
#include <numeric>

#include "scenes.hpp"

namespace talus::solver::testing {
namespace {

class Implicit : public InEachPlace {
 protected:
  /// A column one cell wide between rollers, its lower end fixed, points 2 x 2 x 2 per cell.
  static Domain column(double height, double layer_height) {
    Domain d = ground(6, 6, 1.0, layer_height, [](double, double) { return 0.0; });
    fill(d, {2.5, 3.5, 2.5, 3.5, 0, height});
    return d;
  }
  static SolveOptions column_options() {
    SolveOptions o;
    o.integrator = Integrator::quasi_static;
    o.mapping = Mapping::cartesian;
    o.shape = ShapeKind::linear;
    o.material.model = MaterialModel::hencky;
    o.material.poisson_ratio = 0;
    o.base.law = FrictionLaw::stick;
    for (const auto axis : {Axis::x, Axis::y}) {
      o.walls.push_back({axis, 2.5, Side::above, WallKind::roller});
      o.walls.push_back({axis, 3.5, Side::below, WallKind::roller});
    }
    return o;
  }
  static int steps_to(Solver& solver, double time, StepStats* last = nullptr) {
    solver.set_next_event(time);
    int newton = 0;
    for (;;) {
      const BatchReport batch = solver.advance();
      newton += batch.stats.newton;
      if (last) *last = batch.stats;
      if (batch.clock.halt == at_event) return newton;
      if (batch.clock.halt == failed) {
        ADD_FAILURE();
        return newton;
      }
    }
  }
};

/// Largest error of the first Piola stress over its largest value, and the displacement of the topmost points.
struct ColumnResult {
  double stress_error = 0, top = 0, top_height = 0;
};
ColumnResult measure_column(const Solver& solver, const Scene& scene, const Domain& d, const SolveOptions& o, double weight,
                            double height) {
  const ParticleState s = solver.state().points;
  const auto x = positions(scene.map, scene.grid, solver.ground(), s);
  const auto m = make_material<double>(o.material);
  ColumnResult r;
  double sum = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double start = d.points.height[static_cast<std::size_t>(s.id[p])];
    const MaterialState<double> state{
        {s.elastic[0][p], s.elastic[1][p], s.elastic[2][p], s.elastic[3][p], s.elastic[4][p], s.elastic[5][p]}, s.log_volume[p], 0};
    // Lateral strain is nil, so the first Piola stress is the Kirchhoff stress over the stretch.
    const double piola = kirchhoff_stress(m, state).zz / std::exp(s.log_volume[p]);
    const double error = (piola + weight * (height - start)) / (weight * height);
    sum += error * error;
    if (start > r.top_height) r = {0, start - x[p][2], start};
  }
  r.stress_error = std::sqrt(sum / static_cast<double>(s.size()));
  return r;
}

TEST_P(Implicit, carries_a_columns_own_weight) {
  // validation.md A1: H = 50 m, E = 1 MPa, body force to 200 N/m3 in 20 steps. In a corotated bar P = E (F - 1) exactly.
  const Domain d = column(50, 1);
  SolveOptions o = column_options();
  o.material.model = MaterialModel::corotated;
  o.material.youngs_modulus = 1e6;
  o.material.density = 80;
  o.gravity = {0, 0, -200.0 / 80};
  o.gravity_ramp = 1;
  o.implicit.step = 0.05;
  for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp}) {
    o.shape = shape;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    StepStats stats;
    const int newton = steps_to(*solver, 1.0, &stats);
    const ColumnResult r = measure_column(*solver, scene, d, o, 200, 50);
    const double exact = 200 / 1e6 * (50 * r.top_height - 0.5 * r.top_height * r.top_height);
    std::printf("  A1 %s: stress error (rms) %.2e, top displacement %.6f (%.3f %%), %d Newton, %d linear in the last step\n",
                name_of(shape), r.stress_error, r.top, 100 * (r.top / exact - 1), newton,
                stats.linear);
    // validation.md A1: 0.2 %. Hats lose 0.3 % as points near the top cross cells and leave a cell with one of its two layers.
    EXPECT_LT(std::abs(r.top / exact - 1), shape == ShapeKind::quadratic ? 0.002 : 0.005);
    EXPECT_EQ(solver->clock().step, 20);
    EXPECT_LE(newton, 3 * 20);  // quadratic convergence
  }
}

TEST_P(Implicit, leans_on_a_wall_as_on_the_ground) {
  // The same column laid on its side, its weight along the axis towards a fixed wall: the functions meet walls as they meet the ground.
  // Tolerance: the springs that hold nearly empty nodes lie elsewhere (splines that reached through the wall were 6 % softer).
  SolveOptions o = column_options();
  o.shape = ShapeKind::quadratic;
  o.material.youngs_modulus = 1e5;
  o.gravity_ramp = 1;
  o.implicit.step = 0.25;
  o.implicit.newton_tolerance = o.implicit.linear_tolerance = 1e-11;
  const auto settlement = [&](const Domain& d, const std::array<double, 3>& direction) {
    for (int a = 0; a < 3; ++a) o.gravity[static_cast<std::size_t>(a)] = direction[static_cast<std::size_t>(a)];
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    const Centre before = centre(*solver, scene);
    steps_to(*solver, 1.0);
    const Centre after = centre(*solver, scene);
    return std::hypot(after.x - before.x, after.y - before.y, after.z - before.z);
  };
  const double upright = settlement(column(8, 1), {0, 0, -0.1});
  EXPECT_GT(upright, 0.01);
  Domain d = ground(16, 6, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {3.5, 11.5, 2.5, 3.5, 0, 1});
  o.base.law = FrictionLaw::none;
  o.walls = {{Axis::y, 2.5, Side::above, WallKind::roller}, {Axis::y, 3.5, Side::below, WallKind::roller},
             {Axis::z, 0.0, Side::above, WallKind::roller},  // the floor alone would let it go
             {Axis::x, 3.5, Side::above, WallKind::fixed}};
  EXPECT_NEAR(settlement(d, {-0.1, 0, 0}), upright, 1e-4 * upright);
  o.walls.back() = {Axis::x, 11.5, Side::below, WallKind::fixed};
  EXPECT_NEAR(settlement(d, {0.1, 0, 0}), upright, 1e-4 * upright);
}

TEST_P(Implicit, refines_a_strongly_compacted_column) {
  // validation.md A1b (Charlton, Coombs & Augarde 2017): E = 10 kPa, rho = 80 kg/m3, g to 10 m/s2 in 40 steps.
  SolveOptions o = column_options();
  o.shape = ShapeKind::quadratic;
  o.material.youngs_modulus = 1e4;
  o.material.density = 80;
  o.gravity = {0, 0, -10};
  o.gravity_ramp = 1;
  o.implicit.step = 1.0 / 40;
  double last = 0;
  for (const double h : {50.0 / 4, 50.0 / 8, 50.0 / 16}) {
    Domain d = ground(6, 6, h, h, [](double, double) { return 0.0; });
    fill(d, {2.5 * h, 3.5 * h, 2.5 * h, 3.5 * h, 0, 50});
    o.walls.clear();
    for (const auto axis : {Axis::x, Axis::y}) {
      o.walls.push_back({axis, 2.5 * h, Side::above, WallKind::roller});
      o.walls.push_back({axis, 3.5 * h, Side::below, WallKind::roller});
    }
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    const int newton = steps_to(*solver, 1.0);
    const double error = measure_column(*solver, scene, d, o, 800, 50).stress_error;
    std::printf("  A1b h = %.3f m: stress error (rms) %.3e, order %.2f, %d Newton\n", h, error, last > 0 ? std::log2(last / error) : 0.0, newton);
    EXPECT_TRUE(last == 0 || std::log2(last / error) > 1.0) << std::log2(last / error);  // validation.md A1b
    last = error;
  }
}

TEST_P(Implicit, solves_linear_systems_no_further_than_newton_can_use) {
  // The same equilibrium with fewer linear iterations (Eisenstat & Walker 1996).
  const Domain d = column(30, 1);
  SolveOptions o = column_options();
  o.shape = ShapeKind::quadratic;
  o.material.youngs_modulus = 1e6;
  o.implicit.step = 0.5;
  o.gravity_ramp = 1;
  int linear[2] = {};
  double centre_of[2] = {};
  for (const auto forcing : {Forcing::fixed, Forcing::eisenstat_walker}) {
    const std::size_t which = forcing == Forcing::fixed ? 0 : 1;
    o.implicit.forcing = forcing;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    solver->set_next_event(1.0);
    for (BatchReport batch; batch.clock.halt != at_event;) {
      batch = solver->advance();
      linear[which] += batch.stats.linear;
    }
    centre_of[which] = centre(*solver, scene).z;
  }
  EXPECT_LT(linear[1], linear[0]);
  EXPECT_NEAR(centre_of[1] / centre_of[0], 1, 1e-5);
}

TEST_P(Implicit, swings_a_bar_at_its_own_period) {
  // validation.md B6: a bar fixed at its foot, first mode, period 4 H sqrt(rho / E); no gravity.
  const double height = 10;
  const Domain d = column(height, 0.5);
  SolveOptions o = column_options();
  o.integrator = Integrator::newmark;
  o.transfer = Transfer::flip;
  o.transfer_time = 1e30;
  o.shape = ShapeKind::quadratic;
  o.material.youngs_modulus = 1e6;
  o.material.density = 1000;
  o.gravity = {0, 0, 0};
  const double period = 4 * height / std::sqrt(1e6 / 1000);
  o.implicit.step = period / 200;
  Scene scene = make_scene(d, o);
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    scene.points.velocity[2][p] = 0.05 * std::sin(std::numbers::pi / 2 * d.points.height[p] / height);
  }
  const auto solver = make_solver(scene, o, GetParam());
  const double start = solver->energies().kinetic;
  double before = 1, crossing = 0, least = 1e300;
  for (int n = 1; n <= 220; ++n) {
    steps_to(*solver, n * period / 200);
    const Energies e = solver->energies();
    const double momentum = e.momentum.z / (10 * 1000 * 0.05);
    // The momentum follows cos(2 pi t / T): its third zero crossing, downwards to upwards at 3 T / 4.
    if (before < 0 && momentum >= 0) crossing = (n - momentum / (momentum - before)) / 200;
    before = momentum;
    least = std::min(least, e.kinetic + e.elastic);
  }
  std::printf("  B6 bar: three quarters of the period at %.5f, energy kept %.4f\n", crossing, least / start);
  EXPECT_NEAR(crossing, 0.75, 0.75 * 0.01);
  EXPECT_GT(least / start, 0.97);
}

TEST_P(Implicit, gives_the_same_displacement_by_every_linear_solver) {
  // Half of the column's load in one step, on a wavy ground that the body stands on.
  Domain d = ground(14, 12, 1.0, 1.0, [](double x, double y) { return 0.2 * std::sin(x) + 0.1 * y; });
  fill(d, {4, 8, 4, 7, 0, 4});
  for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp}) {
    std::vector<double> reference;
    for (int kind = 0; kind < 4; ++kind) {
      SolveOptions o;
      o.integrator = Integrator::quasi_static;
      o.shape = shape;
      o.material.model = MaterialModel::hencky;
      o.material.youngs_modulus = 1e6;
      o.base.law = FrictionLaw::stick;
      o.implicit.step = 1;
      o.implicit.newton_tolerance = 1e-10;
      o.implicit.linear_tolerance = 1e-11;
      o.implicit.linear_solver = kind == 0 ? LinearSolver::cholesky : LinearSolver::pcg;
      o.implicit.form = kind <= 1 ? Operator::points : kind == 2 ? Operator::elements : Operator::stencil;
      const Scene scene = make_scene(d, o);
      const auto solver = make_solver(scene, o, GetParam());
      StepStats stats;
      steps_to(*solver, 1.0, &stats);
      ParticleState s = solver->state().points;
      std::vector<double> z(s.size());
      for (std::size_t p = 0; p < s.size(); ++p) {
        z[static_cast<std::size_t>(s.id[p])] = positions(scene.map, scene.grid, solver->ground(), s)[p][2];
      }
      if (kind == 0) {
        reference = z;
        EXPECT_EQ(stats.linear, stats.newton) << "one factorisation an iteration";
        continue;
      }
      double worst = 0;
      for (std::size_t p = 0; p < z.size(); ++p) worst = std::max(worst, std::abs(z[p] - reference[p]));
      EXPECT_LT(worst, 1e-8);
    }
  }
}

TEST_P(Implicit, takes_the_reference_papers_steps) {
  // validation.md A1 by preset = "reference": Newmark at 1e-2 s with damping, PCG against Cholesky.
  const Domain d = column(10, 1);
  std::vector<double> tops;
  for (const auto linear : {LinearSolver::pcg, LinearSolver::cholesky}) {
    SolveOptions o = column_options();
    o.preset = Preset::reference;
    o = with_preset(o);
    o.integrator = Integrator::newmark;
    o.material.model = MaterialModel::linear_elastic;
    o.material.youngs_modulus = 1e6;
    o.material.density = 80;
    o.gravity = {0, 0, -2.5};
    o.gravity_ramp = 2;
    o.damping = 0.05;
    o.implicit.step = 1e-3;
    o.implicit.linear_solver = linear;
    o.implicit.linear_tolerance = 1e-12;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    steps_to(*solver, 2.0);
    const ColumnResult r = measure_column(*solver, scene, d, o, 200, 10);
    tops.push_back(r.top);
    const double exact = 200 / 1e6 * (10 * r.top_height - 0.5 * r.top_height * r.top_height);
    std::printf("  reference preset: top displacement error %.3f %%\n", 100 * (r.top / exact - 1));
    EXPECT_NEAR(r.top / exact, 1, 0.02);
  }
  EXPECT_NEAR(tops[0] / tops[1], 1, 1e-8);
}

/// validation.md A2 at two cells over the depth: a cantilever of 10 x 1 x 1 m, E = 1 GPa, held at x = 0, its last points pulled down.
struct Cantilever {
  Domain domain = ground(28, 10, 0.5, 0.5, [](double, double) { return 0.0; });
  SolveOptions options;
  Cantilever(ShapeKind shape, double k) {
    domain.grid.west = domain.grid.south = -1.75;
    fill(domain, {0, 10, 0, 1, 10, 11});
    options.integrator = Integrator::quasi_static;
    options.mapping = Mapping::cartesian;
    options.shape = shape;
    options.gravity = {0, 0, 0};
    options.material.model = MaterialModel::corotated;
    options.material.youngs_modulus = 1e9;
    options.material.poisson_ratio = 0;
    options.walls.push_back({Axis::x, 0, Side::above, WallKind::fixed});
    options.loads.push_back({{9.7, 10, 0, 1, 10, 11}, {0, 0, -k * 1e9 / 12 / 100}, 1.0});  // k E I / L^2
    options.implicit.linear_solver = LinearSolver::cholesky;
  }
  /// Mean deflection of the last points [m], which lie 1/8 m inside.
  double deflection(const Solver& solver, const Scene& scene) const {
    const ParticleState s = solver.state().points;
    const auto x = positions(scene.map, scene.grid, solver.ground(), s);
    double tip = 0, volume = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      if (domain.points.x[static_cast<std::size_t>(s.id[p])] < 9.7) continue;
      tip += s.volume[p] * (domain.points.height[static_cast<std::size_t>(s.id[p])] - x[p][2]);
      volume += s.volume[p];
    }
    return tip / volume;
  }
};

TEST_P(Implicit, bends_a_cantilever_until_points_leave_their_cells) {
  // 16 % of strain in the outer fibres, the tip moves by 13 cells. Without the filler neither shape gets past a quarter of the load.
  for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp}) {
    Cantilever beam(shape, 3.6);
    beam.options.implicit.step = 0.05;
    const Scene scene = make_scene(beam.domain, beam.options);
    const auto solver = make_solver(scene, beam.options, GetParam());
    steps_to(*solver, 1.0);
    // At the end the beam hangs at about 60 degrees.
    const double error = beam.deflection(*solver, scene) / (0.64684 * 10 - 0.125 * 0.87) - 1;
    std::printf("  A2 %s, h = 0.5 m: tip deflection error %.1f %%\n", name_of(shape), 100 * error);
    EXPECT_LT(std::abs(error), 0.08);  // two cells over the depth
  }
}

TEST_P(Implicit, does_not_lock_at_poissons_ratio_of_nearly_one_half) {
  // validation.md C2: a slender beam bends by P L^3 / (3 E I) whatever Poisson's ratio is, 0.6 % more for shear; at most 5 % from locking.
  const auto bend = [&](ShapeKind shape, double poisson, bool b_bar) {
    Cantilever beam(shape, 0.2);
    beam.options.material.model = MaterialModel::hencky;
    beam.options.material.poisson_ratio = poisson;
    beam.options.implicit.b_bar = b_bar;
    beam.options.implicit.step = 0.5;
    const Scene scene = make_scene(beam.domain, beam.options);
    const auto solver = make_solver(scene, beam.options, GetParam());
    steps_to(*solver, 1.0);
    const double arm = 10 - 0.125;
    return beam.deflection(*solver, scene) / (0.2 / 100 * arm * arm * arm / 3) - 1;
  };
  EXPECT_LT(bend(ShapeKind::linear, 0.49, false), -0.2) << "nothing locks: the test shows nothing";
  for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic}) {
    for (const double poisson : {0.49, 0.499}) {
      const double error = bend(shape, poisson, true);
      std::printf("  nu = %.3f, %s, B-bar: deflection %+.1f %%\n", poisson, name_of(shape), 100 * error);
      EXPECT_LT(std::abs(error), 0.05);
    }
  }
}

TEST_P(Implicit, holds_a_node_once_where_a_roller_meets_the_ground) {
  const Domain d = column(6, 1);
  SolveOptions o = column_options();
  o.base.law = FrictionLaw::coulomb;
  o.walls.push_back({Axis::z, 0, Side::above, WallKind::roller});
  o.material.youngs_modulus = 1e6;
  o.implicit.step = 0.5;
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  EXPECT_LE(steps_to(*solver, 1.0), 12);
  EXPECT_EQ(solver->clock().step, 2);
}

TEST_P(Implicit, tells_a_body_without_support_from_equilibrium) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 7, 4, 7, 3, 6});
  SolveOptions o;
  o.integrator = Integrator::quasi_static;
  o.mapping = Mapping::cartesian;
  o.material.model = MaterialModel::hencky;
  o.implicit.step_cuts = 1;
  o.implicit.linear_iterations = 500;
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  solver->set_next_event(1);
  try {
    solver->advance();
    FAIL() << "a floating body was accepted";
  } catch (const NumericalError& e) {
    EXPECT_NE(std::string(e.what()).find("Hold"), std::string::npos) << e.what();
  }
}

TEST_P(Implicit, meets_an_indefinite_tangent_and_says_so) {
  // A slender column under twenty times its buckling load: compression has made its tangent indefinite before the points have moved.
  for (const auto linear_solver : {LinearSolver::pcg, LinearSolver::cholesky}) {
    Domain d = ground(8, 8, 1.0, 1.0, [](double, double) { return 0.0; });
    fill(d, {3, 5, 3, 5, 0, 16});
    SolveOptions o;
    o.integrator = Integrator::newmark;
    o.mapping = Mapping::cartesian;
    o.material.model = MaterialModel::hencky;
    o.material.youngs_modulus = 1e6;
    o.material.poisson_ratio = 0;
    o.base.law = FrictionLaw::stick;
    o.gravity = {0.01, 0, 0};
    o.loads.push_back({{3, 5, 3, 5, 15, 16}, {0, 0, -2e6}, 0.0});
    o.implicit.step = 1.0;
    o.implicit.linear_solver = linear_solver;
    o.implicit.forcing = Forcing::fixed;  // else the iterations end before they have met the direction
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    solver->set_next_event(1);
    bool indefinite = false;
    for (BatchReport batch; batch.clock.halt != at_event;) {
      batch = solver->advance();
      ASSERT_NE(batch.clock.halt, failed);
      indefinite = indefinite || batch.stats.indefinite;
    }
    EXPECT_TRUE(indefinite);
    const Centre c = centre(*solver, scene);
    EXPECT_TRUE(std::isfinite(c.x) && std::isfinite(c.z));
    EXPECT_LT(c.z, 8);
  }
}

TEST_P(Implicit, carries_a_single_point_and_nodes_without_mass) {
  // Alone in its cells, at a node (so that splines leave layers without weight) and beside one: it falls as the parabola says.
  for (const double x : {5.0, 5.37}) {
    for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp}) {
      for (const auto integrator : {Integrator::newmark, Integrator::explicit_}) {
        Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
        fill(d, {x - 0.25, x + 0.25, 5, 5.5, 6, 6.5});
        ASSERT_EQ(d.points.x.size(), 1U);
        SolveOptions o;
        o.integrator = integrator;
        o.shape = shape;
        o.mapping = Mapping::cartesian;
        o.material.model = MaterialModel::hencky;
        o.implicit.step = 0.05;
        o.implicit.newton_tolerance = 1e-12;
        const Scene scene = make_scene(d, o);
        const auto solver = make_solver(scene, o, GetParam());
        const double start = centre(*solver, scene).z;
        run_to(*solver, 0.5);
        const Centre c = centre(*solver, scene);
        EXPECT_NEAR(c.speed, 9.81 * 0.5, 1e-9);
        // Explicit positions are half a step of its speed ahead.
        const double ahead = integrator == Integrator::explicit_ ? 9.81 * 0.5 * solver->clock().step_size : 0;
        EXPECT_NEAR(start - c.z, 0.5 * 9.81 * 0.25, 1e-9 + ahead);
      }
    }
  }
}

TEST_P(Implicit, slides_down_an_incline_with_friction) {
  const double angle = 30 * std::numbers::pi / 180, slope = std::tan(angle);
  Domain d = ground(40, 16, 1.0, 1.0, [&](double x, double) { return 100 - slope * x; });
  fill(d, {4, 10, 5, 11, 0, 2});
  SolveOptions o;
  o.integrator = Integrator::newmark;
  o.implicit.beta = 1;      // backward Euler in velocity
  o.implicit.alpha = 0.5;
  o.implicit.step = 0.02;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.base.friction_angle = 20;
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  const Centre start = centre(*solver, scene);
  int newton = 0;
  double cfl = 0;
  solver->set_next_event(1.5);
  for (;;) {
    const BatchReport b = solver->advance();
    newton += b.stats.newton;
    cfl = b.stats.over_cfl;
    if (b.clock.halt == at_event) break;
  }
  const Centre end = centre(*solver, scene);
  const double a = 9.81 * (std::sin(angle) - std::tan(20 * std::numbers::pi / 180) * std::cos(angle));
  // Backward Euler: s = a t (t + dt) / 2.
  const double expected = 0.5 * a * 1.5 * (1.5 + 0.02) * std::cos(angle);
  std::printf("  implicit incline: %.2f CFL steps, error %.3f %%, %.1f Newton a step\n", cfl, 100 * ((end.x - start.x) / expected - 1),
              static_cast<double>(newton) / static_cast<double>(solver->clock().step));
  EXPECT_NEAR((end.x - start.x) / expected, 1, 0.02);
}

TEST_P(Implicit, slides_through_a_hollow_as_explicit_steps_do) {
  // Where the ground bends, the reaction turns the path, and friction goes with it.
  Domain d = ground(64, 14, 1.0, 1.0, [](double x, double) { return 0.01 * (44 - x) * (44 - x); });
  fill(d, {8, 12, 5, 9, 0, 2});
  SolveOptions o;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.base.friction_angle = 15;
  const auto slide = [&](Integrator integrator, StepStats& last) {
    o.integrator = integrator;
    o.implicit.step = 0.03;
    o.implicit.newton_tolerance = 1e-5;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    const auto thickness = solver->thickness();
    EXPECT_NEAR(std::accumulate(thickness.begin(), thickness.end(), 0.0), 32, 1e-9) << "before the first step";
    const double start = centre(*solver, scene).x;
    solver->set_next_event(4.0);
    for (BatchReport batch; batch.clock.halt != at_event;) {
      batch = solver->advance();
      EXPECT_NE(batch.clock.halt, failed);
      last.over_cfl = std::max(last.over_cfl, batch.stats.over_cfl);
    }
    return centre(*solver, scene).x - start;
  };
  StepStats stats;
  const double expected = slide(Integrator::explicit_, stats), got = slide(Integrator::newmark, stats);
  std::printf("  hollow at %.0f CFL: way %.3f m, explicit %.3f m\n", stats.over_cfl, got, expected);
  EXPECT_GT(expected, 15);
  EXPECT_GT(stats.over_cfl, 8);
  EXPECT_NEAR(got / expected, 1, 0.008);  // with the arrival's friction counted as Newmark spreads it, 1.1 % short
}

TEST_P(Implicit, lets_a_heap_of_sand_collapse_at_ten_times_the_cfl_step) {
  // A column 1.5 times as high as wide, no cohesion, on a rough floor: yielding, opening, stick and slip in one. Against explicit steps.
  Domain d = ground(26, 6, 0.1, 0.1, [](double, double) { return 0.0; });
  fill(d, {0.35, 0.95, 0.25, 0.35, 0, 0.9});
  SolveOptions o;
  o.mapping = Mapping::cartesian;
  o.material.youngs_modulus = 2e6;
  o.material.poisson_ratio = 0.3;
  o.material.density = 2650;
  o.material.friction_angle = 31;
  o.material.dilatancy_angle = 1;
  o.material.cone = Cone::plane_strain;
  o.base.friction_angle = 28;
  o.walls.push_back({Axis::x, 0.35, Side::above, WallKind::roller});
  o.walls.push_back({Axis::y, 0.25, Side::above, WallKind::roller});
  o.walls.push_back({Axis::y, 0.35, Side::below, WallKind::roller});
  const auto collapse = [&](Integrator integrator, Tangent tangent, StepStats& sums) {
    o.integrator = integrator;
    o.implicit.step = 0.018;
    o.implicit.newton_tolerance = 1e-4;
    o.implicit.linear_tolerance = 1e-3;
    o.implicit.tangent = tangent;
    o.implicit.linear_solver = tangent == Tangent::exact ? LinearSolver::bicgstab : LinearSolver::pcg;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    solver->set_next_event(1.0);
    for (BatchReport batch; batch.clock.halt != at_event;) {
      batch = solver->advance();
      EXPECT_NE(batch.clock.halt, failed);
      sums.newton += batch.stats.newton;
      sums.cuts += batch.stats.cuts;
      sums.over_cfl = std::max(sums.over_cfl, batch.stats.over_cfl);
    }
    return centre(*solver, scene).x - 0.35;
  };
  StepStats none;
  const double expected = collapse(Integrator::explicit_, Tangent::frozen_yield, none);
  EXPECT_GT(expected, 0.4);  // it has moved: its centre began at 0.3 m
  for (const auto tangent : {Tangent::frozen_yield, Tangent::exact}) {
    StepStats sums;
    const double got = collapse(Integrator::newmark, tangent, sums);
    std::printf("  sand at %.0f CFL, %s tangent: centre %.4f m, explicit %.4f m; %d Newton in 56 steps, %d cuts\n", sums.over_cfl,
                tangent == Tangent::exact ? "exact" : "frozen-yield", got, expected, sums.newton, sums.cuts);
    EXPECT_NEAR(got / expected, 1, 0.05);
    EXPECT_GT(sums.over_cfl, 8);
    EXPECT_LE(sums.cuts, 5);
  }
}

TALUS_IN_EACH_PLACE(Implicit);

}  // namespace
}  // namespace talus::solver::testing
