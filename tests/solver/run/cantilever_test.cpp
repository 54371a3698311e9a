// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A soft cantilever that gravity bends at once, until its outer fibres are pulled to a multiple of their length.
#include <algorithm>
#include <cstdio>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double beam_length = 4, beam_bottom = 6;  // [m]

/// A beam of 4 x 1 m in plane strain, held at x = 0 (E = 1 MPa, nu = 0.3, 1,050 kg/m3, 9.8 m/s2), on cells of 0.25 m.
struct SoftBeam {
  Domain domain = ground(26, 9, 0.25, 0.25, [](double, double) { return 0.0; });
  SolveOptions options;
  explicit SoftBeam(MaterialModel model) {
    domain.grid.west = domain.grid.south = -0.875;  // nodes at the planes of the walls
    fill(domain, {0, beam_length, 0, 0.5, beam_bottom, beam_bottom + 1});
    options.mapping = Mapping::cartesian;
    options.gravity = {0, 0, -9.8};
    options.material.model = model;
    options.material.youngs_modulus = 1e6;
    options.material.poisson_ratio = 0.3;
    options.material.density = 1050;
    options.walls = {{Axis::x, 0, Side::above, WallKind::fixed},
                     {Axis::y, 0, Side::above, WallKind::roller},
                     {Axis::y, 0.5, Side::below, WallKind::roller}};
  }
  /// Drop of the lower corner of the free end [m]: of the points there, which lie 1/16 m inside.
  double drop(const Solver& solver, const Scene& scene) const {
    const ParticleState s = solver.state().points;
    const auto x = positions(scene, s);
    double sum = 0, volume = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      const auto seed = static_cast<std::size_t>(s.id[p]);
      if (domain.points.x[seed] < beam_length - 0.125 || domain.points.height[seed] > beam_bottom + 0.125) continue;
      sum += s.volume[p] * (domain.points.height[seed] - x[p][2]);
      volume += s.volume[p];
    }
    return sum / volume;
  }
};

class SoftCantilever : public InEachPlace {};

TEST_P(SoftCantilever, of_neo_hookean_material_holds_and_turns_back_where_finite_elements_do) {
  const SoftBeam beam(MaterialModel::neo_hookean);
  const Scene scene = make_scene(beam.domain, beam.options);
  const auto solver = make_solver(scene, beam.options, GetParam());
  double lowest = 0, when = 0;
  for (int n = 1; n <= 44; ++n) {
    const double time = 0.05 * n;
    run_to(*solver, time);
    const double drop = beam.drop(*solver, scene);
    if (drop > lowest) {
      lowest = drop;
      when = time;
    }
  }
  const double after = beam.drop(*solver, scene);
  std::printf("  lowest: %.3f m at %.2f s, at 2.2 s %.3f m\n", lowest, when, after);
  EXPECT_NEAR(lowest / 3.28, 1, 0.03);
  EXPECT_NEAR(when, 1.05, 0.051);
  EXPECT_LT(after, 0.5 * lowest) << "it swings back in one piece";
}

TEST_P(SoftCantilever, of_neo_hookean_material_falls_as_far_in_newmarks_steps) {
  constexpr double time = 0.5;
  double drop[2];
  for (const auto integrator : {Integrator::explicit_, Integrator::newmark}) {
    SoftBeam beam(MaterialModel::neo_hookean);
    beam.options.integrator = integrator;
    beam.options.implicit.step = 0.01;  // five CFL steps
    const Scene scene = make_scene(beam.domain, beam.options);
    const auto solver = make_solver(scene, beam.options, GetParam());
    run_to(*solver, time);
    drop[integrator == Integrator::newmark ? 1 : 0] = beam.drop(*solver, scene);
  }
  std::printf("  at 0.5 s: %.3f m by explicit steps, %.3f m by Newmark's\n", drop[0], drop[1]);
  // Steps of five CFL steps: trapezoids follow the waves of shorter periods late, which carry a percent of the fall.
  EXPECT_NEAR(drop[1] / drop[0], 1, 0.02);
}

TALUS_IN_EACH_PLACE(SoftCantilever);

}  // namespace
}  // namespace talus::solver::testing
