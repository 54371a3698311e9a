// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Flows that are drawn out to many times their length: no column between their ends is left empty.
#include "tests/solver/scenes.hpp"

namespace talus::solver {
namespace {

using namespace testing;

/// A strip of snow on level ground without friction, whose velocity grows along it: after `time` it is 1 + rate * time
/// times as long everywhere.
struct DrawnStrip {
  static constexpr double middle = 400, half = 40, rate = 0.5, thickness = 1;
  SolveOptions options;
  Scene scene;

  explicit DrawnStrip(Integrator integrator, int points = 2) {
    options = stepping_by(integrator);
    options.material.density = 200;
    options.material.youngs_modulus = 1e5;
    options.base.law = FrictionLaw::none;
    for (const double y : {80.0, 120.0}) options.walls.push_back({Axis::y, y, y < 100 ? Side::above : Side::below});
    Domain domain = ground(160, 40, 5, 0.5, flat);
    domain.grid.west = domain.terrain.grid.west = 0;
    fill(domain, {middle - half, middle + half, 80, 120, 0, thickness}, points);
    scene = make_scene(domain, options);
    for (std::size_t p = 0; p < scene.points.size(); ++p)
      scene.points.velocity[0][p] = rate * (domain.points.x[p] - middle);
  }
};

class DrawnOut : public InEachPlace {};
TALUS_IN_EACH_PLACE(DrawnOut);

TEST_P(DrawnOut, leave_no_column_empty) {
  for (const Integrator integrator : flow_integrators) {
    const DrawnStrip strip(integrator);
    const auto solver = make_solver(strip.scene, strip.options, GetParam());
    constexpr double time = 8;  // five times as long: 2.5 cells from point to point, unsplit
    run_to(*solver, time);
    const std::vector<double> thickness = solver->thickness();
    const MapGrid& map = strip.scene.map;
    const double stretch = 1 + DrawnStrip::rate * time, reach = 0.8 * DrawnStrip::half * stretch;
    double least = 1e9, most = 0;
    for (int i = 0; i < map.columns; ++i) {
      if (std::abs(map.x(i) - DrawnStrip::middle) > reach) continue;
      double sum = 0;
      for (int j = 0; j < map.rows; ++j) sum += thickness[map.index(i, j)];
      least = std::min(least, sum / 8);
      most = std::max(most, sum / 8);
    }
    const double mean = DrawnStrip::thickness / stretch;
    EXPECT_GT(least, 0.8 * mean) << name_of(integrator);
    EXPECT_LT(most, 1.2 * mean) << name_of(integrator);
    const ParticleState points = solver->state().points;
    EXPECT_GT(points.size(), strip.scene.points.size());
    double volume = 0, momentum = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      volume += points.volume[p];
      momentum += points.volume[p] * points.velocity[0][p];
    }
    EXPECT_NEAR(volume, 80 * 40 * DrawnStrip::thickness, 1e-9 * volume);
    EXPECT_NEAR(momentum, 0, 1e-6 * volume * DrawnStrip::rate * DrawnStrip::half);
  }
}

}  // namespace
}  // namespace talus::solver
