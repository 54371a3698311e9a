// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What keys of [solve] need of one another, and the texts of the refusals.
#include "solver/options/solve.hpp"

#include "solver/options/names.hpp"
#include "solver/options/time.hpp"
#include "tests/common/scratch.hpp"
#include "tests/places.hpp"

namespace talus::solver {
namespace {

/// The faults of a recipe, a line each; empty where it is sound.
std::string faults(const std::string& text) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("r.toml", text));
  try {
    recipe.read<SolveOptions>("solve");
  } catch (const RecipeError& error) {
    return error.what();
  }
  return "";
}

TEST(SolveOptions, vectors_and_boxes_have_their_number_of_values) {
  EXPECT_EQ(faults("[solve]\ngravity_m_s2 = [0.0, 1.0]"),
            "[solve] gravity_m_s2 has 2 numbers (it is a vector: east, north, up). Give three: gravity_m_s2 = [0.0, "
            "0.0, 0.0]");
  EXPECT_EQ(faults("[solve]\ninitial_velocity_m_s = [0.0]"),
            "[solve] initial_velocity_m_s has 1 numbers (it is a vector: east, north, up). Give three: "
            "initial_velocity_m_s = [0.0, 0.0, 0.0]");
  EXPECT_EQ(faults("[[solve.load]]\nextent_m = [1.0]\n[[solve.load]]\nforce_N = [1.0]"),
            "[[solve.load]] extent_m or force_N has the wrong number of values (a box has six, a force three). Give "
            "extent_m = [west, south, east, north, bottom, top] and force_N = [east, north, up]\n[[solve.load]] "
            "extent_m or force_N has the wrong number of values (a box has six, a force three). Give extent_m = [west, "
            "south, east, north, bottom, top] and force_N = [east, north, up]");
}

TEST(SolveOptions, the_energy_budget_needs_explicit_steps_and_contact_at_nodes) {
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\nintegrator = \"newmark\""),
            "[solve] energy_budget = true does not go with this integrator or stress_update (losses are counted in "
            "explicit and column-implicit steps with stress_update = \"usl\"). Leave it out, or take integrator = "
            "\"explicit\"");
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\nstress_update = \"musl\""),
            "[solve] energy_budget = true does not go with this integrator or stress_update (losses are counted in "
            "explicit and column-implicit steps with stress_update = \"usl\"). Leave it out, or take integrator = "
            "\"explicit\"");
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\nintegrator = \"auto\""), "");
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\n[[solve.obstacle]]\nname=\"a\""),
            "[[solve.obstacle]] does not go with energy_budget = true (what is lost between nodes is not counted). "
            "Leave energy_budget out");
}

TEST(SolveOptions, keys_of_deleted_solvers_are_refused_with_advice) {
  EXPECT_NE(faults("[solve.implicit]\npreconditioner = \"multigrid\"")
                .find("[solve.implicit] preconditioner: no longer a key. Leave it out; it is the 3 x 3 block of each "
                      "node"),
            std::string::npos);
  EXPECT_NE(faults("[solve.implicit]\nlinear_solver = \"bicgstab\"").find("(no longer a choice). Take"),
            std::string::npos);
  for (const std::string key : {"ground_contact = \"nodes\"", "[solve.implicit]\noperator = \"points\"",
                                "[solve.implicit]\ntangent = \"frozen-yield\""})
    EXPECT_NE(faults("[solve]\n" + key).find(": no longer a key. Leave it out"), std::string::npos) << key;
}

TEST(SolveOptions, obstacles_need_a_solver_without_assembly) {
  EXPECT_EQ(faults("[solve]\nintegrator = "
                   "\"quasi-static\"\n[solve.implicit]\nlinear_solver=\"cholesky\"\n[[solve.obstacle]]\nname=\"a\""),
            "[[solve.obstacle]] does not go with [solve.implicit] linear_solver = \"cholesky\" (contact between nodes "
            "is not in the assembled matrix). Take linear_solver = \"pcg\"");
}

TEST(SolveOptions, holding_the_mass_on_its_bed_needs_explicit_steps_on_a_grid_that_follows_it) {
  for (const std::string steps :
       {"integrator = \"newmark\"", "integrator = \"quasi-static\"", "preset = \"reference\""}) {
    EXPECT_EQ(faults("[solve]\n" + steps + "\n[solve.base]\nseparation = \"none\""),
              "[solve.base] separation = \"none\" with integrator = \"newmark\", \"quasi-static\" or preset = "
              "\"reference\" (Newton's iterations free a base node whose reaction would pull). Take integrator = "
              "\"explicit\", or separation = \"free\"");
  }
  EXPECT_EQ(
      faults("[solve]\nmapping = \"cartesian\"\n[solve.base]\nseparation = \"thin\""),
      "[solve.base] separation = \"thin\" with mapping = \"cartesian\" (its nodes lie up to a layer beside the ground, "
      "and would hold what passes by). Take mapping = \"terrain-following\", or separation = \"free\"");
  EXPECT_EQ(faults("[solve]\nmapping = \"cartesian\"\nintegrator = \"newmark\"\n[solve.base]\nseparation = \"free\""),
            "");
  EXPECT_EQ(faults("[solve.base]\nseparation = \"none\"\nseparation_depth_m = 2.0"),
            "[solve.base] separation_depth_m with separation = \"none\" (it is the depth up to which \"thin\" holds "
            "columns). Leave it out, or take separation = \"thin\"");
}

TEST(SolveOptions, separation_comes_back_from_the_recipe_as_used) {
  const test::Scratch scratch;
  for (const auto& [name, kind] :
       {std::pair{"free", Separation::free}, {"none", Separation::none}, {"thin", Separation::thin}}) {
    SolveOptions o;
    o.base.separation = kind;
    if (kind == Separation::thin) o.base.separation_depth = 2.5;
    const std::string text = recipe::to_used_toml(o, "solve");
    EXPECT_NE(text.find("separation = \"" + std::string(name) + "\""), std::string::npos) << text;
    const recipe::Recipe again(scratch.write("used.toml", text));
    const auto read = again.read<SolveOptions>("solve");
    EXPECT_EQ(read.base.separation, kind);
    EXPECT_EQ(read.base.separation_depth, o.base.separation_depth);
  }
}

TEST(SolveOptions, repeated_bits_need_explicit_steps_without_a_budget) {
  EXPECT_EQ(faults("[solve]\ndeterministic = true\nintegrator = \"newmark\""),
            "[solve] deterministic = true does not go with this integrator or with energy_budget (sums of implicit "
            "steps and of the budget are made in any order on a GPU). Leave it out, or take integrator = \"explicit\" "
            "without energy_budget");
  EXPECT_EQ(faults("[solve]\ndeterministic = true\nenergy_budget = true"),
            "[solve] deterministic = true does not go with this integrator or with energy_budget (sums of implicit "
            "steps and of the budget are made in any order on a GPU). Leave it out, or take integrator = \"explicit\" "
            "without energy_budget");
  EXPECT_EQ(faults("[solve]\ndeterministic = true\nintegrator = \"auto\""), "");
}

TEST(SolveOptions, means_over_elements_need_implicit_steps_and_a_pressure_of_the_volume) {
  EXPECT_EQ(faults("[solve]\n[solve.implicit]\nb_bar=true"),
            "[solve.implicit] b_bar = true has no effect on explicit steps (only implicit steps average the volume "
            "change). Leave it out, or take integrator = \"newmark\" or \"quasi-static\"");
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\n[solve.implicit]\nb_bar=true"),
            "[solve.implicit] b_bar = true has no effect on explicit steps (only implicit steps average the volume "
            "change). Leave it out, or take integrator = \"newmark\" or \"quasi-static\"");
  EXPECT_EQ(
      faults("[solve]\nintegrator=\"newmark\"\n[solve.implicit]\nb_bar=true\n[solve.material]\nmodel=\"corotated\""),
      "[solve.implicit] b_bar = true does not go with this [solve.material] model (its pressure does not follow from "
      "the volume change alone). Take model = \"hencky\" or \"drucker-prager\"");
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\n[solve.implicit]\nb_bar=true\n[[solve.part]]\nrelease=\"x\"\nmodel="
                   "\"corotated\""),
            "[solve.implicit] b_bar = true does not go with this [solve.material] model (its pressure does not follow "
            "from the volume change alone). Take model = \"hencky\" or \"drucker-prager\"\n[solve.implicit] b_bar = "
            "true has no effect on explicit steps (only implicit steps average the volume change). Leave it out, or "
            "take integrator = \"newmark\" or \"quasi-static\"");
}

TEST(SolveOptions, gauges_have_names_of_their_own) {
  EXPECT_EQ(faults("[[solve.gauge]]\nname=\"a\"\nat_m=[1.0, 2.0]\n[[solve.gauge]]\nname=\"a\"\n[[solve.gauge]]"),
            "[[solve.gauge]] name = \"a\" is given twice (its readings are recorded under its name). Rename one\n"
            "[[solve.gauge]] number 3: name = \"\" (its readings are recorded under its name). Give it one of letters, "
            "digits, - and _");
}

TEST(SolveOptions, walls_parts_and_names_have_their_limits) {
  EXPECT_EQ(faults("[[solve.obstacle]]\nname=\"a "
                   "b\"\n[[solve.obstacle]]\n[[solve.obstacle]]\nname=\"c\"\n[[solve.obstacle]]\nname=\"c\""),
            "[[solve.obstacle]] number 1: name = \"a b\" (its forces are recorded under its name). Give it one of "
            "letters, digits, - and _\n[[solve.obstacle]] number 2: name = \"\" (its forces are recorded under its "
            "name). Give it one of letters, digits, - and _\n[[solve.obstacle]] name = \"c\" is given twice (its "
            "forces are recorded under its name). Rename one");
  EXPECT_EQ(faults("[[solve.part]]\nrelease=\"x0\"\n[[solve.part]]\nrelease=\"x1\"\n[[solve.part]]\nrelease=\"x2\"\n[["
                   "solve.part]]\nrelease=\"x3\"\n[[solve.part]]\nrelease=\"x4\"\n[[solve.part]]\nrelease=\"x5\"\n[["
                   "solve.part]]\nrelease=\"x6\"\n[[solve.part]]\nrelease=\"x7\""),
            "[[solve.part]] is given 8 times (a scene has at most 8 materials). Give releases of the same material the "
            "same name, or leave some out");
}

TEST(SolveOptions, strengths_go_together) {
  EXPECT_EQ(faults("[solve.material]\nstiffness=\"auto\"\nmodel=\"hencky\""),
            "[solve.material] stiffness = \"auto\" does not go with this model (what an elastic body does depends on "
            "its stiffness). Take model = \"drucker-prager\", or leave stiffness out");
  EXPECT_EQ(
      faults("[solve.material]\ndilatancy_angle_deg=40\n[[solve.part]]\nrelease=\"x\"\nsoftening_slip_m="
             "1\nresidual_cohesion_Pa=3\nstiffness=\"auto\""),
      "[[solve.part]] release = \"x\" softens to 0 deg and 3 Pa, from 30 deg and 0 Pa (a residual strength is no "
      "larger than the first). Lower residual_friction_angle_deg or residual_cohesion_Pa\n"
      "[[solve.part]] release = \"x\" gives stiffness (it is the whole scene's). Give it in [solve.material]\n"
      "[solve.material] dilatancy_angle_deg = 40 is above friction_angle_deg = 30 (the material would make energy "
      "as it shears). Lower dilatancy_angle_deg; 0 is usual for run-out");
  EXPECT_EQ(faults("[solve.base]\nlaw=\"velocity-weakening\"\npeak_coefficient=0.1"),
            "[solve.base] peak_coefficient = 0.1 is below steady_coefficient = 0.23 (friction would grow with speed). "
            "Swap the two");
}

TEST(SolveOptions, at_most_as_many_walls_as_kernels_hold) {
  std::string walls;
  for (int w = 0; w < 12; ++w) walls += "[[solve.wall]]\n";
  EXPECT_EQ(faults(walls), "");
  EXPECT_EQ(faults(walls + "[[solve.wall]]\n"),
            "[[solve.wall]] is given 13 times (at most 12 walls fit). Leave some out");
}

TEST(SolveOptions, a_key_that_is_gone_is_refused_with_advice) {
  const std::string found = faults("[solve]\nflip_fraction = 0.95");
  EXPECT_NE(found.find("[solve] flip_fraction: no longer a key. Give transfer_time_s"), std::string::npos) << found;
}

TEST(SolveOptions, an_accuracy_is_for_the_integrator_that_chooses) {
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\naccuracy=0.01"), "");
  EXPECT_NE(faults("[solve]\naccuracy=0.01")
                .find("[solve] accuracy has no effect (it belongs to integrator = "
                      "\"auto\")"),
            std::string::npos);
  EXPECT_NE(faults("[solve]\nintegrator=\"auto\"\naccuracy=0.5").find("accuracy = 0.5"), std::string::npos);
}

TEST(SolveOptions, what_follows_from_accuracy_is_not_given_beside_it) {
  const std::string asked = "[solve]\nintegrator=\"auto\"\naccuracy=0.01\n", why = " (it follows from accuracy)";
  EXPECT_NE(faults(asked + "cfl=0.3").find("[solve] cfl beside accuracy" + why), std::string::npos);
}

TEST(SolveOptions, steps_longer_than_lone_points_bear_are_for_columns) {
  EXPECT_EQ(faults("[solve]\ncfl=0.8"), "");
  EXPECT_NE(faults("[solve]\ncfl=0.9").find("[solve] cfl = 0.9 is too large"), std::string::npos);
  EXPECT_EQ(faults("[solve]\ncfl=1.5\nintegrator=\"column-implicit\""), "");
  EXPECT_NE(faults("[solve]\ncfl=1.6\nintegrator=\"column-implicit\""), "");
}

TEST(SolveOptions, longer_steps_by_columns_are_for_what_holds_no_tension) {
  const auto said = [](const std::string& material) {
    return faults("[solve]\ncfl=1.2\nintegrator=\"column-implicit\"\n" + material)
               .find("[solve] cfl = 1.2 is too large for a material that holds tension") != std::string::npos;
  };
  EXPECT_FALSE(said("[solve.material]\ncohesion_Pa=1e4"));
  EXPECT_FALSE(said("[solve.material]\nmodel=\"herschel-bulkley\""));
  EXPECT_TRUE(said("[solve.material]\nmodel=\"hencky\""));
  EXPECT_TRUE(said("[solve.material]\ncohesion_Pa=1e4\ntension_cutoff_Pa=1e3"));
  EXPECT_TRUE(said("[[solve.part]]\nrelease=\"block\"\nmodel=\"neo-hookean\""));
}

TEST(SolveOptions, what_goes_together_is_taken) {
  EXPECT_EQ(faults("[solve]\n[solve.implicit]\nlinear_solver=\"cholesky\"\n[[solve.obstacle]]\nname=\"a\""), "");
}

TEST(SolveOptions, every_integrator_says_what_its_steps_can_do) {
  EXPECT_TRUE(abilities_of(Integrator::explicit_).count_losses);
  EXPECT_FALSE(abilities_of(Integrator::explicit_).solve_systems);
  for (const Integrator some : {Integrator::explicit_, Integrator::automatic}) EXPECT_TRUE(abilities_of(some).obey_cfl);
  for (const Integrator some : {Integrator::newmark, Integrator::quasi_static})
    EXPECT_FALSE(abilities_of(some).obey_cfl);
  for (const Integrator some : {Integrator::explicit_, Integrator::newmark, Integrator::automatic})
    EXPECT_TRUE(abilities_of(some).carry_inertia);
  EXPECT_FALSE(abilities_of(Integrator::quasi_static).carry_inertia);
  for (const Integrator some : {Integrator::newmark, Integrator::quasi_static}) {
    EXPECT_TRUE(abilities_of(some).average_volume);
    EXPECT_FALSE(abilities_of(some).count_losses);
  }
  EXPECT_TRUE(abilities_of(Integrator::automatic).solve_systems);
  EXPECT_FALSE(abilities_of(Integrator::automatic).average_volume) << "some of its steps are explicit";
  EXPECT_TRUE(abilities_of(Integrator::automatic).count_losses) << "it takes no others where losses are counted";
}

/// The TOML of the page on materials that gives one.
std::vector<std::string> materials_of_the_guide() {
  std::ifstream guide(TALUS_SOURCE_DIR "/docs/how-to/bed-and-material.md");
  std::vector<std::string> blocks;
  std::string line, block;
  bool inside = false;
  while (std::getline(guide, line)) {
    if (inside && line == "```") {
      if (block.find("[solve.material]") != std::string::npos) blocks.push_back(block);
      inside = false;
    } else if (inside) {
      block += line + "\n";
    } else if (line == "```toml") {
      inside = true;
      block.clear();
    }
  }
  return blocks;
}

TEST(SolveOptions, what_a_preset_sets_is_not_given_otherwise_beside_it) {
  for (const auto& [key, given] : {std::pair{"integrator", "integrator = \"column-implicit\""},
                                   {"integrator", "integrator = \"auto\""},
                                   {"shape", "shape = \"gimp\""},
                                   {"transfer_time_s", "transfer_time_s = 0.5"}}) {
    EXPECT_EQ(
        faults("[solve]\npreset = \"reference\"\n" + std::string(given)),
        "[solve] " + std::string(key) + " beside preset = \"reference\" (the preset sets it). Leave one of them out");
  }
  EXPECT_EQ(faults("[solve]\npreset = \"reference\"\nintegrator = \"quasi-static\"\nshape = \"linear\""), "");
}

TEST(SolveOptions, a_preset_refuses_what_its_steps_cannot_do) {
  EXPECT_NE(faults("[solve]\npreset = \"reference\"\nenergy_budget = true").find("energy_budget"), std::string::npos);
  EXPECT_NE(faults("[solve]\npreset = \"reference\"\ndeterministic = true").find("deterministic"), std::string::npos);
  EXPECT_EQ(faults("[solve]\npreset = \"reference\"\n[solve.implicit]\nb_bar = true"), "");
}

TEST(SolveOptions, materials_of_the_user_guide_are_sound) {
  const auto blocks = materials_of_the_guide();
  EXPECT_GE(blocks.size(), 3u);
  for (const std::string& block : blocks) EXPECT_EQ(faults(block), "") << block;
}

TEST(SolveOptions, laws_whose_stress_depends_on_the_rate_take_explicit_steps) {
  const std::string fault =
      "[solve] integrator = \"newmark\", \"quasi-static\" or preset = \"reference\" does not go with model = "
      "\"mu-of-i\" (its stress depends on the rate of shear, and Newton's iterations have not been shown to converge "
      "with it). Take integrator = \"explicit\"";
  const std::string law = "[solve.material]\nmodel = \"mu-of-i\"\n";
  for (const char* integrator : {"newmark", "quasi-static"})
    EXPECT_EQ(faults("[solve]\nintegrator = \"" + std::string(integrator) + "\"\n" + law), fault);
  EXPECT_EQ(faults("[solve]\npreset = \"reference\"\n" + law), fault);
  EXPECT_EQ(faults("[solve]\nintegrator = \"newmark\"\n[[solve.part]]\nrelease = \"a\"\nmodel = \"mu-of-i\"\n"), fault);
  EXPECT_EQ(faults("[solve]\nintegrator = \"newmark\"\n[solve.material]\nmodel = \"neo-hookean\"\n"), "");
  for (const char* integrator : {"explicit", "auto"})
    EXPECT_EQ(faults("[solve]\nintegrator = \"" + std::string(integrator) + "\"\n" + law), "");
}

TEST(SolveOptions, friction_of_mu_of_i_grows_with_the_rate) {
  EXPECT_EQ(
      faults("[solve.material]\nmodel = \"mu-of-i\"\nstatic_friction_angle_deg = 33.0"),
      "[solve.material] limiting_friction_angle_deg = 32.76 is not above static_friction_angle_deg = 33 (friction "
      "grows with the rate of shear). Swap the two, or take model = \"drucker-prager\"");
  EXPECT_NE(faults("[solve.material]\nslow_flow = \"creep\"\nstatic_friction_angle_deg = 32.5")
                .find("slow_flow = \"creep\" does not go with friction angles of 32.5 to 32.76 deg"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::solver
