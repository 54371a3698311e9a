// Implicit steps against closed forms, explicit steps and one another.
#include <numbers>

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

TEST_P(Implicit, carries_a_columns_own_weight) {
  // validation.md A1: H = 50 m, E = 1 MPa, body force to 200 N/m3 in 20 steps.
  const Domain d = column(50, 1);
  SolveOptions o = column_options();
  o.material.youngs_modulus = 1e6;
  o.material.density = 80;
  o.gravity = {0, 0, -200.0 / 80};
  o.gravity_ramp = 1;
  o.implicit.step = 0.05;
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  StepStats stats;
  const int newton = steps_to(*solver, 1.0, &stats);
  const ParticleState s = solver->state().points;
  const auto x = positions(scene.map, scene.grid, solver->ground(), s);
  const auto m = make_material<double>(o.material);
  double worst = 0, top = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double height0 = d.points.height[static_cast<std::size_t>(s.id[p])];
    const MaterialState<double> state{{s.elastic[0][p], s.elastic[1][p], s.elastic[2][p], s.elastic[3][p], s.elastic[4][p], s.elastic[5][p]}, s.log_volume[p], 0};
    // Lateral strain is nil, so the first Piola stress is the Kirchhoff stress over the stretch.
    const double piola = kirchhoff_stress(m, state).zz / std::exp(s.elastic[2][p]);
    worst = std::max(worst, std::abs(piola + 200 * (50 - height0)) / 1e4);
    if (height0 > 49.5) top = std::max(top, height0 - x[p][2]);
  }
  std::printf("  column: Piola stress error %.2e, top displacement %.6f, %d Newton, %d linear in the last step\n", worst, top, newton, stats.linear);
  EXPECT_LT(worst, 0.012);
}

TALUS_IN_EACH_PLACE(Implicit);

}  // namespace
}  // namespace talus::solver::testing
