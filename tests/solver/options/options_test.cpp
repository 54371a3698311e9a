// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What keys of [solve], of inflows and of shaking need of one another, and the texts of the refusals.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "solver/options/erosion.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/inflow.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/output.hpp"
#include "solver/options/scheme.hpp"
#include "solver/options/solve.hpp"
#include "solver/options/water.hpp"
#include "tests/common/scratch.hpp"
#include "tests/places.hpp"

namespace talus::solver {
namespace {

/// The faults of a recipe, a line each; empty where it is sound.
std::string faults(const std::string& text) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("r.toml", text));
  return test::fault_of<RecipeError>([&] { recipe.read<SolveOptions>("solve"); });
}

void expect_words(const std::string& fault, const std::string& words) {
  EXPECT_NE(fault.find(words), std::string::npos) << fault;
}

TEST(SolveOptions, vectors_and_boxes_have_their_number_of_values) {
  EXPECT_EQ(faults("[solve]\ngravity_m_s2 = [0.0, 1.0]"),
            "[solve] gravity_m_s2 has 2 numbers (it is a vector: east, north, up). Give three: gravity_m_s2 = [0.0, "
            "0.0, 0.0]");
  EXPECT_EQ(faults("[solve]\ninitial_velocity_m_s = [0.0]"),
            "[solve] initial_velocity_m_s has 1 numbers (it is a vector: east, north, up). Give three: "
            "initial_velocity_m_s = [0.0, 0.0, 0.0]");
  const std::string load =
      "[[solve.load]] extent_m or force_N has the wrong number of values (a box has six, a force three). Give "
      "extent_m = [west, south, east, north, bottom, top] and force_N = [east, north, up]";
  EXPECT_EQ(faults("[[solve.load]]\nextent_m = [1.0]\n[[solve.load]]\nforce_N = [1.0]"), load + "\n" + load);
}

TEST(SolveOptions, water_needs_a_mass_that_it_can_be_in) {
  const auto water = [](const std::string& more) { return faults("[solve.water]\npermeability_m2 = 1e-10\n" + more); };
  EXPECT_EQ(water(""), "");
  expect_words(water("[solve.material]\nmodel = \"mu-of-i\""), "does not go with every model");
  expect_words(water("[solve.material]\ndilatancy_angle_deg = 5.0"), "critical_solid_fraction");
  expect_words(water("[solve.material]\ndensity_kg_m3 = 1000.0"), "would have 1000 kg/m3");
  expect_words(water("[solve.base]\npore_pressure_ratio = 0.2"), "twice");
  expect_words(water("[solve]\nmapping = \"cartesian\""), "cartesian");
  expect_words(faults("[solve.water]\ntable_depth_m = 1.0"), "no water flows");
  expect_words(faults("[solve]\nintegrator = \"newmark\"\n[solve.water]\nlevel_m = 1.0"), "still water");
  EXPECT_EQ(faults("[solve.water]\nlevel_m = 1.0"), "");
  const std::string mud = "[solve.material]\nmodel = \"herschel-bulkley\"\nsolid_fraction_exponent = 10.0";
  EXPECT_EQ(water(mud), "");
  expect_words(faults(mud), "without water");
}

TEST(SolveOptions, erosion_by_rate_needs_a_rate_and_steps_of_a_flow) {
  const std::string by_rate = "[solve.erosion]\nlaw = \"rate\"\n";
  EXPECT_EQ(faults(by_rate + "rate_per_m = 0.01"), "");
  expect_words(faults(by_rate), "without rate_per_m");
  expect_words(faults("[solve.erosion]\nrate_per_m = 0.01"), "without a law");
  expect_words(faults("[solve]\nintegrator = \"newmark\"\n" + by_rate + "rate_per_m = 0.01"), "of a flow alone");
}

TEST(SolveOptions, what_only_flows_know_keeps_auto_from_steps_at_rest) {
  SolveOptions o;
  EXPECT_FALSE(beyond_rest(o));
  o.water.level = 10;
  EXPECT_EQ(beyond_rest(o).key, "[solve.water] level_m");
  o.water = {};
  o.erosion.law = ErosionLaw::rate;
  EXPECT_EQ(beyond_rest(o).key, "[solve.erosion] law = \"rate\"");
}

TEST(SolveOptions, fines_make_the_fluid_heavier_and_stiffer) {
  WaterOptions w;
  w.fines = 0.1;
  const double grains = w.density_of_grains(2000), fluid = w.density_of_fluid(2000);
  EXPECT_NEAR(w.solid_fraction * grains + (1 - w.solid_fraction) * fluid, 2000, 1e-9);
  EXPECT_NEAR(fluid, 0.9 * 1000 + 0.1 * grains, 1e-9);
  EXPECT_NEAR(w.viscosity_of_fluid(), 1.362e-3, 2e-6);  // Thomas (1965)
  w.grain_diameter = 2e-3;
  EXPECT_NEAR(w.permeability_at_start(), 4e-6 * 0.064 / (180 * 0.36), 1e-15);
}

/// What a recipe of [solve.base] says of the bed.
BaseOptions base_of(const std::string& keys) {
  const test::Scratch scratch;
  return recipe::Recipe(scratch.write("r.toml", "[solve.base]\n" + keys)).read<SolveOptions>("solve").base;
}

TEST(SolveOptions, take_mu_for_an_angle_and_k_for_xi) {
  const auto expect_mu = [](double angle, double mu) {
    EXPECT_NEAR(std::tan(angle * std::numbers::pi / 180), mu, 4e-16);
  };
  for (const char* law : {"coulomb", "voellmy"})
    for (const double mu : {0.0, 0.155, 0.3, 1.0}) {
      const BaseOptions base =
          base_of(fmt::format("law = \"{}\"\nfriction_coefficient = {}", law, recipe::toml_number(mu)));
      expect_mu(base.friction_angle, mu);
      EXPECT_TRUE(base.idle().empty()) << law;
    }
  EXPECT_EQ(base_of("law = \"samosat\"\nfriction_coefficient = 0.2").mu(), 0.2);
  EXPECT_EQ(base_of("law = \"samosat\"").mu(), 0.155);
  const BaseOptions grains =
      base_of("law = \"pouliquen\"\nstop_coefficient = 0.3\nsteepest_coefficient = 0.6\nstart_coefficient = 0.35");
  expect_mu(grains.stop_angle, 0.3);
  expect_mu(grains.steepest_angle, 0.6);
  expect_mu(grains.start_angle, 0.35);
  const BaseOptions k = base_of("law = \"voellmy\"\ndrag_coefficient = 0.004");
  EXPECT_DOUBLE_EQ(k.turbulence, SolveOptions{}.gravity_size() / 0.004);
  EXPECT_EQ(k.as_given("turbulence_m_s2", k.turbulence, SolveOptions{}.gravity_size()).first, "drag_coefficient");
}

TEST(SolveOptions, take_one_form_of_a_number) {
  expect_words(faults("[solve.base]\nfriction_angle_deg = 20.0\nfriction_coefficient = 0.3"),
               "[solve.base] friction_coefficient beside friction_angle_deg (they are one quantity");
  expect_words(faults("[solve.base]\nlaw = \"voellmy\"\nturbulence_m_s2 = 500.0\ndrag_coefficient = 0.02"),
               "[solve.base] drag_coefficient beside turbulence_m_s2");
  EXPECT_EQ(faults("[solve.base]\nlaw = \"samosat\"\nfriction_angle_deg = 25.0\nfriction_coefficient = 0.3"), "");
  EXPECT_EQ(base_of("drag_coefficient = 0.004").idle(), std::vector<std::string>{"drag_coefficient"});
}

TEST(SolveOptions, the_energy_budget_needs_explicit_steps_and_contact_at_nodes) {
  for (const std::string other : {"integrator = \"newmark\"", "stress_update = \"musl\""})
    EXPECT_EQ(faults("[solve]\nenergy_budget = true\n" + other),
              "[solve] energy_budget = true does not go with this integrator or stress_update (losses are counted in "
              "explicit and column-implicit steps with stress_update = \"usl\"). Leave it out, or take integrator = "
              "\"explicit\"");
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\nintegrator = \"auto\""), "");
  EXPECT_EQ(faults("[solve]\nenergy_budget = true\n[[solve.obstacle]]\nname=\"a\""),
            "[[solve.obstacle]] does not go with energy_budget = true (what is lost between nodes is not counted). "
            "Leave energy_budget out");
}

TEST(SolveOptions, keys_of_deleted_solvers_are_refused_with_advice) {
  expect_words(faults("[solve.implicit]\npreconditioner = \"multigrid\""),
               "[solve.implicit] preconditioner: no longer a key. Leave it out; it is the 3 x 3 block of each node");
  expect_words(faults("[solve.implicit]\nlinear_solver = \"bicgstab\""), "(no longer a choice). Take");
  for (const std::string key : {"ground_contact = \"nodes\"", "[solve.implicit]\noperator = \"points\"",
                                "[solve.implicit]\ntangent = \"frozen-yield\""})
    expect_words(faults("[solve]\n" + key), ": no longer a key. Leave it out");
}

TEST(SolveOptions, obstacles_need_a_solver_without_assembly) {
  EXPECT_EQ(faults("[solve]\nintegrator = "
                   "\"quasi-static\"\n[solve.implicit]\nlinear_solver=\"cholesky\"\n[[solve.obstacle]]\nname=\"a\""),
            "[[solve.obstacle]] does not go with [solve.implicit] linear_solver = \"cholesky\" (contact between nodes "
            "is not in the assembled matrix). Take linear_solver = \"pcg\"");
}

TEST(SolveOptions, repeated_bits_need_explicit_steps_without_a_budget) {
  for (const std::string other : {"integrator = \"newmark\"", "energy_budget = true"})
    EXPECT_EQ(
        faults("[solve]\ndeterministic = true\n" + other),
        "[solve] deterministic = true does not go with this integrator or with energy_budget (sums of implicit "
        "steps and of the budget are made in any order on a GPU). Leave it out, or take integrator = \"explicit\" "
        "without energy_budget");
  EXPECT_EQ(faults("[solve]\ndeterministic = true\nintegrator = \"auto\""), "");
}

TEST(SolveOptions, means_over_elements_need_implicit_steps_and_a_pressure_of_the_volume) {
  const std::string
      b_bar = "[solve.implicit]\nb_bar=true\n",
      explicit_steps =
          "[solve.implicit] b_bar = true has no effect on explicit steps (only implicit steps average the "
          "volume change). Leave it out, or take integrator = \"newmark\" or \"quasi-static\"",
      model =
          "[solve.implicit] b_bar = true does not go with this [solve.material] model (its pressure does "
          "not follow from the volume change alone). Take model = \"hencky\" or \"drucker-prager\"";
  EXPECT_EQ(faults("[solve]\n" + b_bar), explicit_steps);
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\n" + b_bar), explicit_steps);
  EXPECT_EQ(faults("[solve]\nintegrator=\"newmark\"\n" + b_bar + "[solve.material]\nmodel=\"corotated\""), model);
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\n" + b_bar + "[[solve.part]]\nrelease=\"x\"\nmodel=\"corotated\""),
            model + "\n" + explicit_steps);
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
  std::string parts;
  for (const char name : std::string("01234567")) parts += std::string("[[solve.part]]\nrelease=\"x") + name + "\"\n";
  EXPECT_EQ(faults(parts),
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
  expect_words(faults("[solve]\nflip_fraction = 0.95"), "[solve] flip_fraction: no longer a key. Give transfer_time_s");
}

TEST(SolveOptions, an_accuracy_is_for_the_integrator_that_chooses) {
  EXPECT_EQ(faults("[solve]\nintegrator=\"auto\"\naccuracy=0.01"), "");
  EXPECT_EQ(faults("[solve]\naccuracy=0.01"), "") << "by itself";
  expect_words(faults("[solve]\nintegrator=\"explicit\"\naccuracy=0.01"),
               "[solve] accuracy has no effect (it belongs to integrator = \"auto\")");
  expect_words(faults("[solve]\nintegrator=\"auto\"\naccuracy=0.5"), "accuracy = 0.5");
}

TEST(SolveOptions, what_follows_from_accuracy_is_not_given_beside_it) {
  expect_words(faults("[solve]\nintegrator=\"auto\"\naccuracy=0.01\ncfl=0.3"),
               "[solve] cfl beside accuracy (it follows from accuracy)");
}

TEST(SolveOptions, steps_longer_than_lone_points_bear_are_for_columns) {
  EXPECT_EQ(faults("[solve]\ncfl=0.8"), "");
  expect_words(faults("[solve]\ncfl=0.9"),
               "[solve] cfl = 0.9 is too large for explicit steps, which \"auto\" may take");
  expect_words(faults("[solve]\ncfl=0.9\nintegrator=\"explicit\""),
               "[solve] cfl = 0.9 is too large for this integrator");
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

TEST(SolveOptions, steps_are_as_long_as_their_kind_bears) {
  SolveOptions o;
  EXPECT_EQ(o.step_over_cfl(), 0.5) << "what auto begins with";
  o.integrator = Integrator::column_implicit;
  EXPECT_EQ(o.step_over_cfl(), 1.5);
  o.material.model = MaterialModel::hencky;
  EXPECT_EQ(o.step_over_cfl(), 1) << "it holds tension";
  o.cfl = 0.4;
  EXPECT_EQ(o.step_over_cfl(), 0.4);
}

TEST(SolveOptions, what_goes_together_is_taken) {
  EXPECT_EQ(faults("[solve]\nintegrator=\"explicit\"\n[solve.implicit]\nlinear_solver=\"cholesky\"\n[[solve.obstacle]]"
                   "\nname=\"a\""),
            "");
}

TEST(SolveOptions, every_integrator_says_what_its_steps_can_do) {
  const auto steps = abilities_of(Integrator::explicit_), chosen = abilities_of(Integrator::automatic),
             newmark = abilities_of(Integrator::newmark), statics = abilities_of(Integrator::quasi_static);
  EXPECT_TRUE(steps.count_losses && steps.obey_cfl && steps.carry_inertia && !steps.solve_systems);
  EXPECT_TRUE(newmark.average_volume && newmark.carry_inertia && !newmark.obey_cfl && !newmark.count_losses);
  EXPECT_TRUE(statics.average_volume && !statics.carry_inertia && !statics.obey_cfl && !statics.count_losses);
  EXPECT_TRUE(chosen.obey_cfl && chosen.carry_inertia && chosen.solve_systems);
  EXPECT_FALSE(chosen.average_volume) << "some of its steps are explicit";
  EXPECT_TRUE(chosen.count_losses) << "it takes no others where losses are counted";
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
                                   {"integrator", "integrator = \"explicit\""},
                                   {"shape", "shape = \"gimp\""},
                                   {"transfer_time_s", "transfer_time_s = 0.5"}}) {
    EXPECT_EQ(
        faults("[solve]\npreset = \"reference\"\n" + std::string(given)),
        "[solve] " + std::string(key) + " beside preset = \"reference\" (the preset sets it). Leave one of them out");
  }
  EXPECT_EQ(faults("[solve]\npreset = \"reference\"\nintegrator = \"quasi-static\"\nshape = \"linear\""), "");
}

TEST(SolveOptions, a_preset_refuses_what_its_steps_cannot_do) {
  for (const std::string key : {"energy_budget", "deterministic"})
    expect_words(faults("[solve]\npreset = \"reference\"\n" + key + " = true"), key);
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
  expect_words(faults("[solve.material]\nslow_flow = \"creep\"\nstatic_friction_angle_deg = 32.5"),
               "slow_flow = \"creep\" does not go with friction angles of 32.5 to 32.76 deg");
}

const std::string line = "line_m = [[0.0, 5.0], [10.0, 5.0]]\n";
const std::string rows = "hydrograph = [[0.0, 3.0], [60.0, 0.0]]\n";

/// What a recipe with these lines in [solve] and in [[solve.inflow]] is refused with; empty where it is sound.
std::string inflow_faults(const std::string& inflow, const std::string& solve = "") {
  return faults("[solve]\n" + solve + "\n[[solve.inflow]]\n" + inflow);
}

TEST(InflowOptions, take_a_line_a_hydrograph_and_one_of_speed_depth_and_froude_number) {
  for (const char* one : {"speed_m_s = 4.0", "depth_m = 1.0", "froude = 1.1"})
    EXPECT_EQ(inflow_faults(line + rows + one), "");
  EXPECT_EQ(inflow_faults(line + "file = \"q.csv\"\nspeed_m_s = 4.0"), "");
  expect_words(inflow_faults(line + rows), "0 of speed_m_s, depth_m and froude are given");
  expect_words(inflow_faults(line + rows + "speed_m_s = 4.0\nfroude = 1.0"), "2 of speed_m_s");
  expect_words(inflow_faults(rows + "froude = 1.0"), "line_m has 0 points");
  expect_words(inflow_faults("line_m = [[1.0, 5.0], [1.0, 5.0]]\n" + rows + "froude = 1.0"), "one point");
}

TEST(InflowOptions, refuse_rows_that_are_no_hydrograph) {
  const std::string rest = line + "froude = 1.0\n";
  expect_words(inflow_faults(rest), "neither file nor hydrograph");
  expect_words(inflow_faults(rest + rows + "file = \"q.csv\""), "file beside hydrograph");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0, 2.0], [5.0, 3.0]]"), "5 before 5");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0]]"),
               "hydrograph[1] (a row of two numbers is wanted)");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0]]"), "has one row");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0, -2.0]]"), "hydrograph[1][1] = -2");
}

TEST(InflowOptions, go_with_every_integrator_that_has_inertia) {
  const std::string inflow = line + rows + "froude = 1.0\n";
  for (const char* integrator : {"explicit", "column-implicit", "newmark", "auto"})
    EXPECT_EQ(inflow_faults(inflow, std::string("integrator = \"") + integrator + "\""), "");
  expect_words(inflow_faults(inflow, "integrator = \"quasi-static\""), "does not go with integrator");
}

TEST(InflowOptions, are_called_by_their_number_or_a_name_that_is_theirs_alone) {
  InflowOptions o;
  EXPECT_EQ(inflow_name(o, 1), "inflow-2");
  o.name = "gully";
  EXPECT_EQ(inflow_name(o, 1), "gully");
  const std::string one = "name = \"a\"\n" + line + rows + "froude = 1.0\n";
  expect_words(inflow_faults(one + "[[solve.inflow]]\n" + one), "\"a\" is given twice");
}

/// What a recipe with these lines in [solve] and in [solve.shaking] is refused with; empty where it is sound.
std::string shaking_faults(const std::string& solve, const std::string& shaking) {
  return faults("[solve]\n" + solve + "\n[solve.shaking]\n" + shaking);
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
  SolveOptions o;
  o.obstacles.emplace_back();
  o.walls.push_back({.axis = Axis::z, .material_is = Side::above});
  EXPECT_FALSE(beyond_columns(o));
  o.walls.push_back({.axis = Axis::z, .material_is = Side::below});
  EXPECT_EQ(beyond_columns(o).key, "a [[solve.wall]] across z above the material");
}

TEST(Hindrances, of_rest_are_named_by_their_key) {
  const auto key = [](auto change) {
    SolveOptions o;
    change(o);
    return beyond_rest(o).key;
  };
  EXPECT_EQ(key([](SolveOptions& o) { o.material.model = MaterialModel::mu_of_i; }), "model = \"mu-of-i\"");
  EXPECT_EQ(key([](SolveOptions& o) { o.deterministic = true; }), "[solve] deterministic = true");
  EXPECT_EQ(key([](SolveOptions& o) { o.energy_budget = true; }), "[solve] energy_budget = true");
}

}  // namespace
}  // namespace talus::solver
