// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run begins with from equilibrium, and the maps and volumes of its end.
#include "solver/run/products.hpp"

#include <numeric>

#include "solver/run/gravity_loading.hpp"
#include "solver/run/thickness.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// A sheet of ground (release 0) of 8 m3 beside a block (release 1) of 4 m3.
class Products : public ::testing::Test {
 protected:
  Products() : domain_(ground(20, 20, 1.0, 1.0, [](double, double) { return 0.0; })) {
    fill(domain_, {4, 8, 4, 6, 0, 1});
    const std::size_t sheet = domain_.points.size();
    fill(domain_, {12, 14, 12, 14, 0, 1});
    for (std::size_t p = sheet; p < domain_.points.size(); ++p) domain_.points.release[p] = 1;
    domain_.release_names = {"ground", "block"};
    domain_.erodible = 1;
    scene_ = make_scene(domain_, options_);
    state_ = first_state(scene_, make_settings(options_, scene_.grid).common);
    everywhere_ = thickness_of(scene_, options_, scene_.points, [](std::size_t) { return true; });
  }
  RunEnd end() const { return {domain_, options_, scene_, state_, everywhere_}; }
  /// Moves a point east by whole cells.
  void move(std::size_t p, int cells) { state_.points.cell[0][p] += cells; }

  Domain domain_;
  SolveOptions options_;
  Scene scene_;
  SolverState state_;
  std::vector<double> everywhere_;
};

TEST_F(Products, ground_belongs_to_the_slide_once_it_moved_by_more_than_a_cell) {
  EXPECT_FALSE(belongs_to_slide(end(), 0));
  EXPECT_TRUE(belongs_to_slide(end(), domain_.points.size() - 1));
  move(0, 1);
  EXPECT_FALSE(belongs_to_slide(end(), 0));
  move(0, 1);
  EXPECT_TRUE(belongs_to_slide(end(), 0));
}

TEST_F(Products, volumes_close) {
  move(0, 3);
  const SlideVolumes v = slide_volumes(end(), 0);
  EXPECT_NEAR(v.released, 4, 1e-12);
  EXPECT_NEAR(v.entrained, 0.125, 1e-12);
  EXPECT_NEAR(v.final, 4.125, 1e-12);
  domain_.erodible = 0;
  EXPECT_NEAR(slide_volumes(end(), 0).released, 12, 1e-12);
  EXPECT_EQ(slide_volumes(end(), 0).entrained, 0);
}

TEST_F(Products, maps_tell_releases_and_ground_apart) {
  move(0, 3);
  state_.maps.arrival_time[5] = 2;
  state_.maps.peak_pressure[5] = 3000;
  const auto now = thickness_of(scene_, options_, state_.points, [](std::size_t) { return true; });
  const RunMaps maps = final_maps(end(), now);
  ASSERT_EQ(maps.deposit_of.size(), 2U);
  EXPECT_EQ(maps.deposit_of[0].first, "ground");
  EXPECT_NEAR(sum(maps.deposit_of[0].second), 0.125, 1e-12);
  EXPECT_NEAR(sum(maps.deposit_of[1].second), 4, 1e-12);
  EXPECT_NEAR(sum(maps.deposit_thickness), 4.125, 1e-12);
  EXPECT_NEAR(sum(maps.initial_thickness), 4, 1e-12);
  EXPECT_NEAR(sum(maps.eroded_depth), 0.125, 1e-12);
  EXPECT_EQ(maps.peak_pressure_kPa[5], 3);
  EXPECT_EQ(maps.arrival_time[5], 2);
  EXPECT_TRUE(std::isnan(maps.arrival_time[6]));
}

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
