// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From initiation to run-out in one run: a block that rests by Newmark's steps is pushed, and slides by steps implicit
// along columns.
#include <cstdio>

#include "solver/run/gravity_loading.hpp"
#include "solver/run/stepper.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double pushed_slope = 20 * M_PI / 180, pushed_bed = 25 * M_PI / 180;
constexpr double push = 3;         // [m/s2]
constexpr double push_begins = 8;  // [s]
constexpr double block_mass = 6 * 4 * 2 * 2000.0;

SolveOptions pushed_block() {
  SolveOptions o;
  o.integrator = Integrator::automatic;
  o.flow = Integrator::column_implicit;
  o.cfl = 0.8;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.material.density = 2000;
  o.base.friction_angle = 25;
  o.gravity_loading_steps = 5;
  LoadOptions load;
  load.extent = {0, 0, 1000, 1000, -10, 100};
  load.force = {block_mass * push * std::cos(pushed_slope), 0, -block_mass * push * std::sin(pushed_slope)};
  load.from = push_begins;
  o.loads = {load};
  return o;
}

double centre_of_block(const Scene& scene, const Solver& solver) {
  double sum = 0;
  const auto points = positions(scene, solver.state().points);
  for (const auto& p : points) sum += p[0];
  return sum / static_cast<double>(points.size());
}

/// What a run went through.
struct HandedOver {
  double way = 0;                   ///< horizontal [m]
  long long implicit = 0;           ///< batches of implicit steps before the push
  long long implicit_of_slide = 0;  ///< once the first step after the push, which finds the motion, is over
  double momentum = 0;              ///< at the end [kg m/s]
};

HandedOver run_pushed(const Scene& scene, const SolveOptions& o, double end) {
  Stepper stepper(scene, o, CpuDevice::make());
  stepper.begin(first_state(scene, make_settings(o, scene.grid).common));
  HandedOver out;
  const double from = centre_of_block(scene, stepper.solver());
  while (stepper.time() < end) {
    const BatchReport batch = stepper.advance(stepper.time() < push_begins ? push_begins : end);
    if (batch.stats.newton > 0) ++(stepper.time() > push_begins + 1.5 ? out.implicit_of_slide : out.implicit);
  }
  out.way = centre_of_block(scene, stepper.solver()) - from;
  const Energies e = stepper.solver().energies();
  out.momentum = std::sqrt(dot(e.momentum, e.momentum));
  return out;
}

TEST(HandOver, from_rest_by_newmark_to_a_slide_by_columns_keeps_the_way_of_a_rigid_block) {
  Domain d = ground(40, 12, 1.0, 1.0, [](double x, double) { return 100 - std::tan(pushed_slope) * x; });
  fill(d, {6, 12, 4, 8, 0, 2});
  const SolveOptions o = pushed_block();
  Scene scene = make_scene(d, o);
  scene.points = loaded_by_gravity(scene, o, CpuDevice::make());
  constexpr double end = 10;
  ::testing::internal::CaptureStderr();
  const HandedOver found = run_pushed(scene, o, end);
  std::string said = ::testing::internal::GetCapturedStderr();
  const double pull = push + 9.81 * (std::sin(pushed_slope) - std::tan(pushed_bed) * std::cos(pushed_slope));
  const double way = 0.5 * pull * std::pow(end - push_begins, 2) * std::cos(pushed_slope);
  std::printf("  way %.4f of %.4f m, momentum %.4g of %.4g kg m/s, %lld implicit batches\n%s", found.way, way,
              found.momentum, block_mass * pull * (end - push_begins), found.implicit, said.c_str());
  EXPECT_GT(found.implicit, 0) << "at rest Newmark's steps take less work";
  EXPECT_EQ(found.implicit_of_slide, 0);
  EXPECT_NEAR(found.way, way, 0.02 * way);  // two cells thick: validation.md B1 allows 2 to 3 %
  EXPECT_NEAR(found.momentum, block_mass * pull * (end - push_begins), 0.02 * block_mass * pull * (end - push_begins));
  EXPECT_NE(said.find("taken over: kinetic energy"), std::string::npos) << said;
  const std::size_t changed = said.rfind("changed by ");
  ASSERT_NE(changed, std::string::npos) << said;
  char* rest = said.data() + changed + std::string("changed by ").size();
  const double kinetic = std::strtod(rest, &rest);
  ASSERT_TRUE(std::string(rest).starts_with(" J, ")) << said;
  const double elastic = std::strtod(rest + 4, &rest);
  ASSERT_TRUE(std::string(rest).starts_with(" J, ")) << said;
  const double momentum = std::strtod(rest + 4, &rest);
  EXPECT_TRUE(std::string(rest).starts_with(" kg m/s")) << said;
  EXPECT_LT(std::abs(kinetic) + std::abs(elastic), 1e-12 * found.momentum * found.momentum / block_mass);
  EXPECT_LT(momentum, 1e-12 * found.momentum);
}

TEST(HandOver, a_push_gives_its_impulse_from_its_own_time_on_whatever_the_steps) {
  Domain d = ground(40, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {6, 12, 4, 8, 20, 22});
  SolveOptions o = pushed_block();
  o.integrator = Integrator::newmark;
  o.implicit.step = 0.5;
  o.implicit.newton_tolerance = 1e-9;
  o.gravity = {0, 0, 0};
  o.gravity_loading_steps = 0;
  const Scene scene = make_scene(d, o);
  Stepper stepper(scene, o, CpuDevice::make());
  stepper.begin(first_state(scene, make_settings(o, scene.grid).common));
  while (stepper.time() < push_begins) stepper.advance(push_begins);
  EXPECT_LT(length(stepper.solver().energies().momentum), 1e-9 * block_mass * push);
  while (stepper.time() < push_begins + 2) stepper.advance(push_begins + 2);
  EXPECT_NEAR(length(stepper.solver().energies().momentum), block_mass * push * 2, 1e-6 * block_mass * push);
}

}  // namespace
}  // namespace talus::solver::testing
