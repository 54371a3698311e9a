// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A run from its first record to its last.
#include "solver/run/run_loop.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/run/run_file.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double rise = 0.5;  ///< of the ramp, over its way

Domain block_on_a_ramp() {
  Domain d = ground(24, 12, 1.0, 1.0, [](double x, double) { return rise * x; });
  fill(d, {14, 18, 4, 8, 0, 1});
  return d;
}

class RunToItsEnd : public InEachPlace {};

/// A block that slides from rest without friction is fastest at the end: the last row of the history and the map of
/// peak speed know of it, whether or not the points are due to be sorted at that very step.
TEST_P(RunToItsEnd, is_recorded_wherever_points_are_sorted) {
  const test::Scratch scratch;
  const RunPaths files(scratch.folder());
  const Domain domain = block_on_a_ramp();
  SolveOptions options;
  options.material.model = MaterialModel::hencky;
  options.material.youngs_modulus = 1e6;
  options.base.law = FrictionLaw::none;
  options.largest_step = 0.01;
  const double gain = 0.01 * 9.81 * rise / std::sqrt(1 + rise * rise);  // of speed, in a step
  double before = 27 * gain;
  for (int steps = 28; steps < 40; ++steps) {  // of which there are 32 between sorts
    SCOPED_TRACE(steps);
    options.end_time = 0.01 * steps;
    Simulation(drafted(domain, options), make_device(GetParam()), files, "").run("ramp", "Ramp");
    const talus::Run run = read_run(files.run);
    EXPECT_EQ(run.history.at("time_s").values.back(), options.end_time);
    EXPECT_NEAR(static_cast<double>(run.summary.steps), steps, 1);
    const double fastest = *std::max_element(run.maps.peak_speed.begin(), run.maps.peak_speed.end());
    EXPECT_GT(fastest, before + 0.5 * gain);
    before = fastest;
  }
}

TALUS_IN_EACH_PLACE(RunToItsEnd);

}  // namespace
}  // namespace talus::solver::testing
