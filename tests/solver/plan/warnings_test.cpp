// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said and refused of a recipe's numbers, of its accelerogram and of its inflows before a run.
#include "solver/plan/describe_plan.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/step_choice.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

Domain two_metres_of_mass() {
  Domain d = filled(ground(12, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.5 * x; }), {4, 8, 4, 8, 0, 2});
  d.release_thickness = d.terrain;
  for (double& t : d.release_thickness.values) t = 2;
  return d;
}

SolveOptions mass_on_bed(double mass, double bed) {
  SolveOptions o;
  o.material.friction_angle = mass;
  o.base.friction_angle = bed;
  return o;
}

std::vector<std::string> warnings(const SolveOptions& o, const Domain& d = two_metres_of_mass()) {
  return test::messages_of([&] { warn_of_plan(begun(d, o)); });
}

/// The only one.
std::string warning(const SolveOptions& o, const Domain& d = two_metres_of_mass()) {
  const auto lines = warnings(o, d);
  EXPECT_EQ(lines.size(), 1u);
  return lines.empty() ? "" : lines.front();
}

bool says(const std::vector<std::string>& lines, const std::string& words) {
  for (const std::string& line : lines)
    if (line.find(words) != std::string::npos) return true;
  return false;
}

TEST(Warnings, are_silent_of_a_mass_that_is_stronger_than_its_bed) {
  EXPECT_TRUE(warnings(mass_on_bed(30, 20)).empty());
  EXPECT_TRUE(warnings(mass_on_bed(20.01, 20)).empty()) << "simple shear mobilises the tangent";
}

TEST(Warnings, name_numbers_of_other_laws) {
  SolveOptions o = mass_on_bed(35, 20);
  o.material.yield_stress = 120;
  EXPECT_TRUE(
      test::holds(warning(o), {"[solve.material] yield_stress_Pa has no effect with model = \"drucker-prager\""}));
  o = mass_on_bed(35, 25);
  o.base.law = FrictionLaw::samosat;
  o.base.turbulence = 700;
  EXPECT_TRUE(test::holds(warning(o), {"[solve.base] friction_angle_deg, turbulence_m_s2 have no effect with law = "
                                       "\"samosat\""}));
  o = mass_on_bed(35, 20);
  o.base.law = FrictionLaw::voellmy;
  o.base.turbulence = 700;
  EXPECT_TRUE(warnings(o).empty()) << "its coefficient is Coulomb's";
}

TEST(Warnings, name_a_mass_that_gives_way_inside) {
  EXPECT_TRUE(test::holds(warning(mass_on_bed(17, 25)), {"0.306", "friction_angle_deg = 17", "0.466 (25.0 deg)",
                                                         "as on a bed of 17.0 deg", "33.1 deg or more"}));
}

TEST(Warnings, count_cohesion_pore_pressure_rasters_and_parts) {
  SolveOptions o = mass_on_bed(17, 25);
  // 2 m of 2,000 kg/m3 press with 39 kPa; 7 kPa make up for 0.16 of that.
  o.material.cohesion = 7e3;
  EXPECT_TRUE(warnings(o).empty());
  o = mass_on_bed(26, 25);
  o.material.pore_pressure_ratio = 0.5;
  EXPECT_EQ(warnings(o).size(), 1u);
  o.base.pore_pressure_ratio = 0.5;
  EXPECT_TRUE(warnings(o).empty()) << "water carries as much of the bed's pressure";
  o = mass_on_bed(26, 25);
  Domain rough = two_metres_of_mass();
  rough.bed.emplace_back("friction_angle_deg", rough.terrain);
  for (double& angle : rough.bed[0].second.values) angle = 10;
  EXPECT_TRUE(warnings(o, rough).empty());
  rough.bed[0].second.values[7] = 35;
  EXPECT_TRUE(says(warnings(o, rough), "35.0 deg"));
  o.parts = {{.release = "lower", .material = o.material}};
  o.parts[0].material.friction_angle = 20;
  EXPECT_TRUE(says(warnings(o), "[[solve.part]] \"lower\""));
}

TEST(Warnings, take_the_most_that_laws_of_columns_ask) {
  SolveOptions o = mass_on_bed(15, 20);
  o.base.law = FrictionLaw::samosat;  // at rest twice mu
  o.base.friction_coefficient = 0.13;
  EXPECT_TRUE(warnings(o).empty());
  o.base.friction_coefficient = 0.14;
  EXPECT_TRUE(says(warnings(o), "the bed asks up to 0.280 (15.6 deg)"));
  o = mass_on_bed(31, 20);
  o.base.law = FrictionLaw::pouliquen;  // under the thinnest layer tan 22.2 + tan 30.7 - tan 21 = 0.618
  EXPECT_TRUE(says(warnings(o), "the bed asks up to 0.618 (31.7 deg)"));
  o.material.friction_angle = 32;
  EXPECT_TRUE(warnings(o).empty());
  Domain rough = two_metres_of_mass();
  rough.bed.emplace_back("steepest_angle_deg", rough.terrain);
  for (double& angle : rough.bed[0].second.values) angle = 30;
  rough.bed[0].second.values[7] = 40;
  EXPECT_TRUE(says(warnings(o, rough), "the bed asks up to 0.863"));
}

TEST(Warnings, count_what_joins_friction_in_implicit_steps) {
  SolveOptions o = mass_on_bed(30, 20);  // 2 m press with 39 kPa; 10 kPa are 0.255 of that
  o.base.cohesion = 10e3;
  EXPECT_TRUE(warnings(o).empty()) << "it acts on whole columns";
  o.integrator = Integrator::newmark;
  EXPECT_TRUE(says(warnings(o), "the bed asks up to 0.619"));
  o.base.cohesion = 0;
  o.base.law = FrictionLaw::voellmy;
  o.base.bartelt_cohesion = 20e3;  // (1 - 0.364) 20 kPa (1 - exp(-39.24 / 20)) is 0.279 of the pressure
  EXPECT_TRUE(says(warnings(o), "the bed asks up to 0.643"));
}

TEST(Warnings, count_columns_one_cell_wide_that_forget_their_stress) {
  Domain d = two_metres_of_mass();
  for (double& t : d.release_thickness.values) t = 0;
  for (int i = 3; i < 7; ++i) d.release_thickness.at(i, 3) = d.release_thickness.at(i, 9) = 2;
  SolveOptions o = mass_on_bed(30, 20);
  o.integrator = Integrator::column_implicit;
  EXPECT_TRUE(warnings(o, d).empty()) << "a ridge has company";
  d.release_thickness.at(9, 6) = 4;
  EXPECT_TRUE(test::holds(warning(o, d), {"20 % of the release", "cfl = 1.5, above 0.5"}));
  o.cfl = 0.5;
  EXPECT_TRUE(warnings(o, d).empty());
  o.cfl = 1;
  o.material.tension_cutoff = 1e3;
  EXPECT_TRUE(warnings(o, d).empty());
}

TEST(Warnings, name_a_cone_that_would_carry_tension) {
  EXPECT_TRUE(warnings(mass_on_bed(40, 20)).empty());
  EXPECT_TRUE(test::holds(warning(mass_on_bed(45, 20)), {"friction_angle_deg = 45", "1.000 p", "0.866 p", "40.9 deg"}));
  SolveOptions triaxial = mass_on_bed(36, 20);
  triaxial.material.cone = Cone::compression;
  EXPECT_TRUE(warnings(triaxial).empty());
  triaxial.material.friction_angle = 38;
  EXPECT_EQ(warnings(triaxial).size(), 1u);
}

TEST(Warnings, look_at_the_angles_and_grains_of_mu_of_i) {
  SolveOptions o = mass_on_bed(30, 20);
  o.material.model = MaterialModel::mu_of_i;
  o.material.density = 1500;
  EXPECT_TRUE(warnings(o).empty());
  o.base.friction_angle = 25;
  EXPECT_TRUE(test::holds(
      warning(o), {"0.382", "static_friction_angle_deg = 20.9", "as on a bed of 20.9 deg", "33.1 deg or more"}));
  o.base.friction_angle = 20;
  o.material.limiting_friction_angle = 42;
  EXPECT_TRUE(says(warnings(o), "limiting_friction_angle_deg = 42"));
  o.material.limiting_friction_angle = 33;
  o.material.density = 2600;
  EXPECT_TRUE(says(warnings(o), "grain_density_kg_m3 = 2450"));
}

TEST(Warnings, look_at_the_packing_of_mu_of_i) {
  SolveOptions o = mass_on_bed(30, 20);
  o.material.model = MaterialModel::mu_of_i;
  o.material.density = 1500;
  o.material.volume_fraction = 0.62;  // of 2,450 kg/m3
  EXPECT_TRUE(warnings(o).empty());
  o.material.density = 1800;  // partly full of water
  EXPECT_TRUE(warnings(o).empty());
  for (const double density : {1400.0, 2000.0}) {
    o.material.density = density;
    EXPECT_TRUE(says(warnings(o), "have 1519, and 1899 with water")) << density;
  }
}

TEST(Warnings, are_silent_of_mud_whose_strength_is_no_friction) {
  SolveOptions o = mass_on_bed(30, 25);
  o.material.model = MaterialModel::herschel_bulkley;
  EXPECT_TRUE(warnings(o).empty());
}

TEST(Warnings, are_silent_of_a_bed_that_sticks_or_does_not_rub) {
  SolveOptions o = mass_on_bed(17, 20);
  for (const auto law : {FrictionLaw::none, FrictionLaw::stick}) {
    o.base.law = law;
    EXPECT_TRUE(warnings(o).empty());
  }
}

/// A slab on level ground, and a record of two triangles, each of 4 m/s2 and a second.
struct ShakenSlab {
  test::Scratch scratch;
  Domain domain = ground(20, 20, 2.0, 1.0, flat);
  SolveOptions options;
  ShakenSlab() {
    fill(domain, {16, 24, 16, 24, 0, 2});
    release(domain, {8, 12}, {8, 12}, 2);
    options.shaking.file = scratch.write("record.csv", "time_s east\n0 0\n0.5 4\n1 0\n1.5 -4\n2 0\n");
    options.shaking.start = 3;
  }
  Scene scene() const { return make_scene(domain, options); }
  std::string refusal(std::vector<std::string> accept = {}) const {
    return test::fault_of<DataError>(
        [&] { test::findings_of([&] { refuse_implausible(*drafted(domain, options)); }, std::move(accept)); });
  }
  std::vector<std::string> warnings() const {
    return test::messages_of([&] { warn_of_shaking(scene().shaking, options); });
  }
};

TEST(ShakingWords, name_samples_times_and_largest_numbers) {
  EXPECT_EQ(shaking_words(ShakenSlab().scene().shaking), "5 samples from 3 to 5 s, up to 4 m/s2 and 2 m/s");
}

TEST(ShakingWords, warn_of_ground_that_does_not_come_to_rest) {
  ShakenSlab slab;
  EXPECT_TRUE(slab.warnings().empty());
  slab.options.shaking.file = slab.scratch.write("drift.csv", "time_s east\n0 0\n0.5 4\n1 0\n1.5 -3.6\n2 0\n");
  const auto lines = test::messages_of([&] { warn_of_plan(begun(slab.domain, slab.options)); });
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(
      lines.back().find("[solve.shaking] at the end of the accelerogram the ground still moves at 0.2 m/s, 10 % of"),
      0u)
      << lines.back();
}

TEST(ShakingWords, warn_of_a_run_that_ends_before_the_record) {
  ShakenSlab slab;
  slab.options.end_time = 4.5;
  const std::vector<std::string> lines = slab.warnings();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines.front(),
            "[solve.shaking] the run ends at 4.5 s and the accelerogram at 5 s: its last 0.5 s do not act. Give "
            "end_time_s = 5 or more");
}

TEST(ShakingWords, no_earthquake_beyond_five_g_passes_unless_it_is_named) {
  ShakenSlab slab;
  EXPECT_EQ(slab.refusal(), "");
  slab.options.shaking.unit = ShakingUnit::g;
  slab.options.shaking.scale = 2;  // 8 g
  const std::string refusal = slab.refusal();
  EXPECT_TRUE(test::holds(refusal, {"[solve.shaking] file shakes the ground with up to 78.5 m/s2 (scale = 2)"}));
  EXPECT_TRUE(test::holds(refusal, {"a scale of 1.2 or less", "accept = [\"strong-shaking\"] in [solve]"}));
  EXPECT_EQ(slab.refusal({"strong-shaking"}), "");
}

TEST(ShakingWords, stiffness_reckons_with_the_speed_that_shaking_gives) {
  ShakenSlab slab;
  const StiffnessDemand shaken = lowest_stiffness(slab.options, begun(slab.domain, slab.options).bound);
  const double fast = begun(slab.domain, slab.options).bound.speed;
  slab.options.shaking = {};
  const StiffnessDemand still = lowest_stiffness(slab.options, begun(slab.domain, slab.options).bound);
  EXPECT_NEAR(fast, begun(slab.domain, slab.options).bound.speed + 2, 1e-12);
  EXPECT_GT(shaken.modulus, still.modulus);
  EXPECT_NE(shaken.reason.find("which the energy line and the shaking allow"), std::string::npos) << shaken.reason;
}

TEST(ShakingWords, the_start_of_the_record_is_an_event) {
  ShakenSlab slab;
  slab.options.frame_interval = slab.options.history_interval = 100;
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(Schedule(slab.options).next_event(0, passed), 3);
  EXPECT_EQ(Schedule(slab.options).next_event(3, passed), 60);
}

TEST(ShakingWords, the_history_has_what_acts_where_the_ground_shakes_alone) {
  ShakenSlab slab;
  slab.options.energy_budget = true;
  const auto has = [&](const char* name) { return History(slab.options, slab.scene()).rows().find(name) != nullptr; };
  for (const char* name : {"shaking_x_m_s2", "ground_velocity_z_m_s", "shaking_work_J"}) {
    slab.options.shaking.file = slab.scratch / "record.csv";
    EXPECT_TRUE(has(name)) << name;
    slab.options.shaking = {};
    EXPECT_FALSE(has(name)) << name;
  }
}

TEST(ShakingRun, waits_for_the_end_of_the_record_and_calls_its_work_no_fault) {
  ShakenSlab slab;
  slab.options.stop_kinetic_fraction = 0.5;
  slab.options.end_time = 8;
  slab.options.history_interval = 0.1;
  const auto run = [&](const char* folder) {
    std::filesystem::create_directories(slab.scratch / folder);
    return Simulation(drafted(slab.domain, slab.options), make_device(On::cpu), RunPaths(slab.scratch / folder), "")
        .run("", "");
  };
  const RunSummary shaken = run("shaken");
  EXPECT_GE(shaken.time_end, 5);
  EXPECT_LT(shaken.time_end, 8) << "it stops once the slab has come to rest";
  EXPECT_FALSE(std::isfinite(shaken.sanity.energy_gain)) << "unknown, for shaking does work";
  EXPECT_EQ(shaken.sanity.words, "sane");
  slab.options.shaking = {};
  const RunSummary still = run("still");
  EXPECT_LT(still.time_end, 3) << "what the slab does by itself has died down before the ground shakes";
  EXPECT_TRUE(std::isfinite(still.sanity.energy_gain));
}

Domain tilted() {
  return ground(40, 20, 2.0, 0.5, [](double x, double) { return 100 - 0.2 * x; });
}

SolveOptions letting_in(double discharge) {
  SolveOptions o;
  InflowOptions inflow;
  inflow.line = {{10, 10}, {10, 30}};
  inflow.hydrograph = {{0, discharge}, {20, discharge}};
  inflow.speed = 5;
  o.inflows = {inflow};
  o.end_time = 30;
  return o;
}

TEST(InflowWords, tell_the_largest_flow) {
  const Domain d = tilted();
  const Scene scene = make_scene(d, letting_in(60));
  EXPECT_EQ(inflow_words(scene.inflow.summaries.at(0)),
            "inflow-1: 1200 m3 from 0 to 20 s; at its largest 60 m3/s over 20 m of the line, 0.612 m deep, at 5 m/s "
            "(Froude number 2.1)");
  EXPECT_TRUE(test::messages_of([&] { warn_of_inflows(begin_scene(d, letting_in(60)), letting_in(60)); }).empty());
}

TEST(InflowWords, warn_of_thin_flows_and_of_what_comes_too_late) {
  const Domain d = tilted();
  SolveOptions o = letting_in(10);
  o.end_time = 15;
  const auto lines = test::messages_of([&] { warn_of_inflows(begin_scene(d, o), o); });
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("the run ends at 15 s, before 50 m3 of its hydrograph"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("it enters 0.102 m deep at most, less than half a layer of 0.5 m"), std::string::npos);
}

TEST(InflowWords, are_of_a_flow_whose_head_begins_the_energy_line) {
  const EnergyLine line = begun(tilted(), letting_in(60)).bound.line;
  // The plane at the line, the depth and the head of the speed: 98 + 0.61 + 25 / 19.62.
  EXPECT_NEAR(line.z, 98 + 0.612 + 25 / 19.62, 0.01);
  EXPECT_NEAR(line.x, 10, 1e-9);
}

}  // namespace
}  // namespace talus::solver::testing
