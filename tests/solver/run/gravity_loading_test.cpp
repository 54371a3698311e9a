// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Start from equilibrium.
#include "solver/run/gravity_loading.hpp"

#include <gtest/gtest.h>

#include "solver/options/walls.hpp"
#include "solver/scene/make_scene.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(GravityLoading, gives_the_points_the_stress_of_the_mass_at_rest) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {1.5, 10.5, 1.5, 10.5, 0, 4});  // between walls that go through nodes
  SolveOptions o;
  o.gravity_loading_steps = 2;
  for (const double face : {1.5, 10.5}) {
    for (const Axis axis : {Axis::x, Axis::y}) {
      WallOptions wall;
      wall.axis = axis;
      wall.position = face;
      wall.material_is = face < 5 ? Side::above : Side::below;
      o.walls.push_back(wall);
    }
  }
  Scene scene = make_scene(d, o);
  scene.points = loaded_by_gravity(scene, o, CpuDevice::make());
  const ParticleState& s = scene.points;
  // Confined compression: sigma_zz = -rho g (H - z) gives the volume strain sigma_zz / M.
  const Material<double> m = make_material<double>(o.material);
  const double modulus = m.bulk_modulus + 4 * m.shear_modulus / 3;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double expected = -2000 * 9.81 * (4 - d.points.height[p]) / modulus;
    EXPECT_NEAR(s.log_volume[p], expected, 0.08 * 2000 * 9.81 * 4 / modulus) << "at height " << d.points.height[p];
    EXPECT_NEAR(s.elastic[0][p] + s.elastic[1][p] + s.elastic[2][p], 0, 1e-12) << "the volume is kept apart";
    EXPECT_EQ(s.velocity[2][p], 0);
  }
}

}  // namespace
}  // namespace talus::solver::testing
