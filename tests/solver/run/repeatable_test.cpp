// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// deterministic = true: the same bits on every run, and the same slide.
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class Repeatable : public InEachPlace {
 protected:
  /// A heap that collapses on a slope until it has crossed several blocks of columns.
  static SolverState collapse(bool deterministic, Precision precision, ShapeKind shape,
                              Integrator integrator = Integrator::explicit_) {
    Domain d = ground(64, 48, 1.0, 1.0, [](double x, double y) { return 0.3 * x + 0.1 * y; });
    fill(d, {30, 44, 14, 30, 0, 5});
    SolveOptions o;
    o.precision = precision;
    o.integrator = integrator;
    o.shape = shape;
    o.material.youngs_modulus = 1e6;
    o.base.friction_angle = 12;
    o.deterministic = deterministic;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, 2);
    return solver->state();
  }
};

TEST_P(Repeatable, gives_the_same_bits_on_every_run) {
  for (const auto& [precision, integrator] : {std::pair{Precision::double_, Integrator::explicit_},
                                              {Precision::single_, Integrator::explicit_},
                                              {Precision::double_, Integrator::column_implicit}}) {
    for (const ShapeKind shape : {ShapeKind::quadratic, ShapeKind::gimp}) {
      SCOPED_TRACE(name_of(shape));
      const SolverState a = collapse(true, precision, shape, integrator),
                        b = collapse(true, precision, shape, integrator);
      EXPECT_EQ(a.clock.step, b.clock.step);
      EXPECT_EQ(a.clock.time, b.clock.time);
      EXPECT_EQ(a.points.id, b.points.id);
      for (int q = 0; q < 3; ++q) {
        EXPECT_EQ(a.points.offset[q], b.points.offset[q]);
        EXPECT_EQ(a.points.velocity[q], b.points.velocity[q]);
      }
      for (int q = 0; q < 6; ++q) EXPECT_EQ(a.points.elastic[q], b.points.elastic[q]);
      EXPECT_EQ(a.maps.peak_speed, b.maps.peak_speed);
      EXPECT_EQ(a.maps.peak_thickness, b.maps.peak_thickness);
    }
  }
}

TEST_P(Repeatable, differs_from_the_usual_order_by_rounding_alone) {
  const SolverState a = collapse(true, Precision::double_, ShapeKind::quadratic),
                    b = collapse(false, Precision::double_, ShapeKind::quadratic);
  const auto moments = [](const SolverState& s) {
    std::vector<double> sums(4);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      for (int q = 0; q < 3; ++q)
        sums[static_cast<std::size_t>(q)] += (s.points.cell[q][p] + s.points.offset[q][p]) * s.points.volume[p];
      sums[3] += s.points.volume[p];
    }
    return sums;
  };
  const auto x = moments(a), y = moments(b);
  for (std::size_t q = 0; q < 3; ++q)
    EXPECT_NEAR(x[q] / x[3], y[q] / y[3], 1e-6);  // cells; rounding grows as sand flows
}

TALUS_IN_EACH_PLACE(Repeatable);

}  // namespace
}  // namespace talus::solver::testing
