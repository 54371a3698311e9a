// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the keys of [solve.shaking] need of one another and of the rest.
#include "solver/options/shaking.hpp"

#include <gtest/gtest.h>

#include <string>

#include "common/error.hpp"
#include "solver/options/solve.hpp"
#include "tests/common/scratch.hpp"

namespace talus::solver {
namespace {

/// What a recipe with these lines in [solve] and in [solve.shaking] is refused with; empty where it is sound.
std::string shaking_faults(const std::string& solve, const std::string& shaking) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("r.toml", "[solve]\n" + solve + "\n[solve.shaking]\n" + shaking));
  return test::fault_of<RecipeError>([&] { recipe.read<SolveOptions>("solve"); });
}

TEST(ShakingOptions, go_with_every_integrator_that_has_inertia) {
  const std::string file = "file = \"record.csv\"";
  for (const char* integrator : {"explicit", "column-implicit", "newmark", "auto"})
    EXPECT_EQ(shaking_faults(std::string("integrator = \"") + integrator + "\"", file), "");
  EXPECT_EQ(shaking_faults("preset = \"reference\"", file), "");
  EXPECT_EQ(shaking_faults("integrator = \"quasi-static\"", file),
            "[solve.shaking] does not go with integrator = \"quasi-static\" (shaking acts by inertia, which a sequence "
            "of equilibria leaves out). Take integrator = \"explicit\", \"column-implicit\" or \"newmark\"; for a "
            "pseudo-static analysis leave [solve.shaking] out and tilt gravity_m_s2");
}

TEST(ShakingOptions, say_nothing_without_a_file) {
  EXPECT_EQ(shaking_faults("integrator = \"quasi-static\"", ""), "");
  for (const char* key : {"scale = 2.0", "unit = \"g\"", "start_s = 1.0", "azimuth_deg = 0.0"})
    EXPECT_EQ(shaking_faults("", key),
              "[solve.shaking] without file (the other keys say how an accelerogram is read). Name one: file = "
              "\"record.csv\", or leave the table out");
}

TEST(ShakingOptions, refuse_what_would_not_shake) {
  EXPECT_EQ(shaking_faults("", "file = \"record.csv\"\nscale = 0.0"),
            "[solve.shaking] scale = 0 (the accelerogram would have no effect). Leave [solve.shaking] out, or give "
            "another scale");
  EXPECT_EQ(shaking_faults("end_time_s = 10.0", "file = \"record.csv\"\nstart_s = 10.0"),
            "[solve.shaking] start_s = 10 with end_time_s = 10 (the run ends before the ground shakes). Give a smaller "
            "start_s, or a larger end_time_s");
}

}  // namespace
}  // namespace talus::solver
