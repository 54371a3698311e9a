// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// --profile: every kernel of a step by its name, and what it says that it moves.
#include "solver/parallel/profile.hpp"

#include <algorithm>
#include <chrono>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/bandwidth.hpp"
#include "solver/run/profile_report.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct Plain {};
template <class Inner>
struct Wrapped {
  using Named = Inner;
};

TEST(KernelNames, are_those_of_their_types) {
  EXPECT_EQ(kernel_name<Plain>(), "Plain");
  EXPECT_EQ(kernel_name<Wrapped<Plain>>(), "Plain");
  EXPECT_EQ((kernel_name<std::pair<Plain, int>>()), "pair");
}

class ProfileOf : public InEachPlace {};

TEST_P(ProfileOf, a_slide_names_its_kernels_and_takes_no_longer_than_the_run) {
  const AnyDevice device = make_device(GetParam());
  Profile& profile = device.profile();
  const auto calls_of = [&](const std::string& name) {
    long calls = 0;
    for (const auto& k : profile.kernels()) calls += k.name == name ? k.calls : 0;
    return calls;
  };
  const auto seconds_of = [](const auto& entries) {
    double sum = 0;
    for (const auto& e : entries) sum += e.seconds;
    return sum;
  };
  Domain domain = ground(24, 16, 1, 1, [](double x, double) { return 0.3 * x; });
  fill(domain, {8, 14, 5, 11, 0, 4});
  const SolveOptions options;
  const Scene scene = make_scene(domain, options);
  const auto solver = make_solver(scene, options, device);
  solver->set_next_event(1e9);
  const long gathers = calls_of("GridToParticle");
  const double phases = seconds_of(profile.phases()), kernels = seconds_of(profile.kernels());
  profile.turn_on();
  const auto begun = std::chrono::steady_clock::now();
  std::int64_t steps = solver->clock().step;
  while (solver->clock().step < steps + 30) solver->advance();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  profile.turn_off();
  steps = solver->clock().step - steps;
  EXPECT_GE(calls_of("GridToParticle") - gathers, steps) << "a batch may start more steps than it takes";
  EXPECT_LT(seconds_of(profile.phases()) - phases, 1.01 * wall);
  EXPECT_LT(seconds_of(profile.kernels()) - kernels, 1.01 * wall);
  EXPECT_GT(seconds_of(profile.kernels()) - kernels, 0);
  const auto gather = std::find_if(profile.kernels().begin(), profile.kernels().end(),
                                   [](const auto& k) { return k.name == "GridToParticle"; });
  // Position twice, velocity and affine velocity, strain and volume twice, the home key: 12 B + 46 numbers + 8 B; and
  // the nodes.
  EXPECT_GT(gather->bytes / static_cast<double>(gather->calls),
            static_cast<double>(solver->particle_count()) * (2 * 12 + 32 * 8 + 8));
  EXPECT_EQ(profile.phases()[gather->phase].name, "grid to points");
  const std::string csv = profile_csv(profile, 1e9);
  EXPECT_NE(csv.find("ParticleToGrid,points to grid,"), std::string::npos) << csv;
  double shares = 0;
  for (const auto& [owner, bytes] : solver->memory()) shares += static_cast<double>(bytes);
  EXPECT_EQ(shares, static_cast<double>(solver->bytes()));
}

TALUS_IN_EACH_PLACE(ProfileOf);

TEST(CopyBandwidth, is_that_of_a_memory) {
  const double copy = copy_bandwidth(CpuDevice::make());
  EXPECT_GT(copy, 1e8);
  EXPECT_LT(copy, 1e13);
}

}  // namespace
}  // namespace talus::solver::testing
