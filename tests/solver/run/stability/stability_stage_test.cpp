// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From domain.vdb to the files of a search for the factor of safety.
#include "solver/run/stability/stability_stage.hpp"

#include "common/run/run_file.hpp"
#include "common/stage/console.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

namespace fs = std::filesystem;

/// A block of 2 m on a plane that falls by a quarter, on a bed of 30 degrees.
class StabilityStage : public ::testing::Test {
 protected:
  StabilityStage()
      : domain_(ground(12, 12, 1.0, 1.0, [](double x, double) { return 100 - 0.25 * x; })),
        context_{recipe::Recipe(scratch_.write("recipe.toml", "[scene]\nname = \"block\"\n")), scratch_.folder(), false,
                 "test"} {
    fill(domain_, {4, 8, 4, 8, 0, 2});
    options_.material.model = MaterialModel::hencky;
    options_.base.friction_angle = 30;
    options_.stability.factor_of_safety = true;
    options_.stability.tolerance = 0.1;
  }

  Facts found() { return find_stability(context_, options_, make_device(On::cpu), domain_); }

  test::Scratch scratch_;
  Domain domain_;
  SolveOptions options_;
  StageContext context_;
};

TEST_F(StabilityStage, says_what_the_domain_was_warned_of_where_it_is_checked) {
  domain_.findings = {test::finding(Severity::warning, "coarse-grid", "the grid is coarse")};
  context_.check_only = true;
  EXPECT_EQ(test::findings_of([&] { found(); }), domain_.findings);
}

TEST_F(StabilityStage, writes_the_factor_and_the_ground_at_rest) {
  const Facts used = found();
  const fs::path out = scratch_.folder();
  EXPECT_EQ(context_.results, (std::vector<fs::path>{out / "run.h5", out / "stability.json"}));
  const talus::Run run = read_run(out / "run.h5");
  EXPECT_EQ(run.summary.steps, 0);
  EXPECT_EQ(run.summary.scene, "block");
  EXPECT_EQ(fact(used, "id"), fact(run.summary.provenance, run_id));
  // tan(30 deg) over the slope; the bracket is 10 % wide.
  EXPECT_NEAR(std::stod(fact(used, "stability.factor_of_safety")), std::tan(std::numbers::pi / 6) / 0.25, 0.1 * 2.31);
}

TEST_F(StabilityStage, writes_nothing_where_it_is_only_asked_for_a_check) {
  context_.check_only = true;
  EXPECT_TRUE(found().empty());
  EXPECT_TRUE(context_.results.empty());
  EXPECT_FALSE(fs::exists(scratch_.folder() / "run.h5"));
}

}  // namespace
}  // namespace talus::solver::testing
