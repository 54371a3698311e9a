// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Options of shaking, and what keeps integrators from a scene.
#include "solver/options/shaking.hpp"

#include "solver/options/hindrances.hpp"
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

TEST(Hindrances, none_stand_in_the_way_of_a_plain_recipe) {
  const SolveOptions o;
  EXPECT_FALSE(beyond_columns(o));
  EXPECT_FALSE(beyond_rest(o));
}

TEST(Hindrances, of_columns_are_walls_above) {
  SolveOptions contact;
  contact.obstacles.emplace_back();
  EXPECT_FALSE(beyond_columns(contact));
  SolveOptions floor;
  floor.walls.push_back({.axis = Axis::z, .material_is = Side::above});
  EXPECT_FALSE(beyond_columns(floor));
  SolveOptions lid;
  lid.walls.push_back({.axis = Axis::z, .material_is = Side::below});
  EXPECT_EQ(beyond_columns(lid).key, "a [[solve.wall]] across z above the material");
}

TEST(Hindrances, of_rest_are_named_by_their_key) {
  const auto key = [](auto change) {
    SolveOptions o;
    change(o);
    return beyond_rest(o).key;
  };
  EXPECT_EQ(key([](SolveOptions& o) { o.material.model = MaterialModel::mu_of_i; }), "model = \"mu-of-i\"");
  EXPECT_EQ(key([](SolveOptions& o) { o.base.separation = Separation::thin; }), "[solve.base] separation = \"thin\"");
  EXPECT_EQ(key([](SolveOptions& o) { o.deterministic = true; }), "[solve] deterministic = true");
  EXPECT_EQ(key([](SolveOptions& o) { o.energy_budget = true; }), "[solve] energy_budget = true");
}

}  // namespace
}  // namespace talus::solver
