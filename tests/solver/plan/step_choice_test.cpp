// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What "auto" and accuracy settle before a run: which steps, how long, how stiff, and why.
#include "solver/plan/step_choice.hpp"

#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slope of 30 degrees, cells of 10 m in layers of this height [m], with a slab on it.
Domain slab_on_layers(double layer_height) {
  Domain d = ground(40, 12, 10, layer_height, [](double x, double) { return 0.577 * (400 - x); });
  release(d, {6, 14}, {4, 8}, 10);
  fill(d, {60, 140, 40, 80, 0, 10});
  return d;
}

SolveOptions chosen_at(std::optional<double> accuracy) {
  SolveOptions o;
  o.accuracy = accuracy;
  o.base.friction_angle = 20;
  return o;
}

StepChoice steps_of(const Domain& domain, const SolveOptions& options) {
  return choose_steps(domain, options, begun(domain, options).bound);
}

std::string unkept(const Domain& domain, const SolveOptions& options) {
  const auto found =
      test::messages_of([&] { warn_of_unkept_accuracy(domain, options, begun(domain, options).bound.line); });
  return found.empty() ? "" : found.at(0);
}

TEST(StepChoice, takes_columns_where_layers_are_thin) {
  const StepChoice thin = steps_of(slab_on_layers(1), chosen_at(0.01));
  EXPECT_EQ(thin.flow, Integrator::column_implicit);
  EXPECT_TRUE(thin.rests);
  ASSERT_EQ(thin.reasons.size(), 2u);
  EXPECT_TRUE(test::holds(thin.reasons[0], {"a flow takes column-implicit steps", "explicit steps of"}));
  const StepChoice cubes = steps_of(slab_on_layers(10), chosen_at(0.01));
  EXPECT_EQ(cubes.flow, Integrator::explicit_) << "a column's step is half as dear again and no longer";
}

TEST(StepChoice, takes_shorter_steps_and_stiffer_rock_for_a_finer_accuracy) {
  double last_cfl = 0, last_strain = 0;
  for (const double accuracy : {0.002, 0.005, 0.01, 0.05}) {
    const StepChoice choice = steps_of(slab_on_layers(1), chosen_at(accuracy));
    EXPECT_GE(choice.cfl, last_cfl);
    EXPECT_LE(choice.cfl, 1.5);
    EXPECT_GT(strain_for(accuracy), last_strain);
    last_cfl = choice.cfl;
    last_strain = strain_for(accuracy);
  }
  EXPECT_GT(last_cfl, steps_of(slab_on_layers(1), chosen_at(0.002)).cfl);
}

TEST(StepChoice, takes_the_longest_steps_by_columns_for_what_holds_no_tension) {
  SolveOptions o = chosen_at(0.05);
  EXPECT_EQ(steps_of(slab_on_layers(1), o).cfl, 1.5);
  o.material.tension_cutoff = 1e3;
  EXPECT_EQ(steps_of(slab_on_layers(1), o).cfl, 1);
}

TEST(StepChoice, without_an_accuracy_takes_steps_as_long_as_their_kind_does_by_itself) {
  SolveOptions o = chosen_at({});
  EXPECT_EQ(steps_of(slab_on_layers(1), o).cfl, 1.5);
  o.walls.push_back({.axis = Axis::z, .material_is = Side::below});
  EXPECT_EQ(steps_of(slab_on_layers(1), o).cfl, 0.5) << "explicit ones";
  o.cfl = 0.3;
  EXPECT_EQ(steps_of(slab_on_layers(1), o).cfl, 0.3);
}

TEST(StepChoice, takes_short_steps_by_columns_where_columns_stand_alone) {
  Domain d = slab_on_layers(1);
  for (int column = 6; column < 14; ++column)
    for (int row = 4; row < 8; ++row) d.release_thickness.at(column, row) = (column + row) % 2 == 0 ? 20 : 0;
  EXPECT_EQ(steps_of(d, chosen_at({})).cfl, 0.5);
  EXPECT_EQ(steps_of(d, chosen_at(0.01)).cfl, 0.5);
  SolveOptions o = chosen_at({});
  o.shape = ShapeKind::linear;
  EXPECT_EQ(steps_of(d, o).cfl, 1.5);
}

TEST(StepChoice, says_why_columns_are_out_of_the_question) {
  SolveOptions o = chosen_at(0.01);
  o.walls.push_back({.axis = Axis::z, .material_is = Side::below});
  const StepChoice below = steps_of(slab_on_layers(1), o);
  EXPECT_EQ(below.flow, Integrator::explicit_);
  EXPECT_NE(below.reasons[0].find("a [[solve.wall]] across z above the material"), std::string::npos);
}

/// Waves 1.5 m high and four cells long under a slab of this thickness [m]: between neighbouring cells slopes change by
/// a tenth, and an arc over a cell rises by a tenth of a metre over its chord.
Domain slab_on_waves(double thickness) {
  Domain d = slab_on_layers(1);
  for (double& t : d.release_thickness.values) t *= thickness / 10;
  for (int row = 0; row < d.grid.rows; ++row)
    for (int column = 0; column < d.grid.columns; ++column)
      d.terrain.at(column, row) += 0.75 * std::cos(column * M_PI / 2 + 0.7);
  return d;
}

TEST(StepChoice, takes_short_steps_on_ground_rough_for_the_flow) {
  const StepChoice thin = steps_of(slab_on_waves(4), chosen_at({})), thick = steps_of(slab_on_waves(20), chosen_at({}));
  EXPECT_EQ(thin.flow, Integrator::column_implicit);
  EXPECT_EQ(thin.cfl, 0.5);
  EXPECT_NE(thin.reasons[1].find("within a cell the ground bends by 0.0"), std::string::npos) << thin.reasons[1];
  EXPECT_EQ(thick.cfl, 1.5);
  EXPECT_EQ(steps_of(slab_on_waves(4), chosen_at(0.1)).cfl, 0.5) << "longer ones move a tenth of the deposit";
  EXPECT_EQ(steps_of(slab_on_waves(4), chosen_at(0.02)).flow, Integrator::explicit_) << "columns would take 0.2";
  SolveOptions o = chosen_at({});
  o.cfl = 0.8;
  EXPECT_EQ(steps_of(slab_on_waves(4), o).cfl, 0.8) << "as the recipe says";
}

TEST(StepChoice, says_where_an_accuracy_cannot_be_kept) {
  const std::string words = unkept(slab_on_waves(4), chosen_at(0.01));
  EXPECT_TRUE(
      test::holds(words, {"[solve] accuracy = 0.01 is not kept on this ground: within a cell it bends by 0.0"}));
  EXPECT_EQ(unkept(slab_on_waves(20), chosen_at(0.01)), "");
  EXPECT_EQ(unkept(slab_on_waves(4), chosen_at(0.05)), "");
  EXPECT_EQ(unkept(slab_on_waves(4), chosen_at({})), "");
}

TEST(StepChoice, takes_no_implicit_steps_where_something_keeps_from_them) {
  const auto rests = [](auto change) {
    SolveOptions o = chosen_at(0.01);
    change(o);
    const StepChoice choice = steps_of(slab_on_layers(1), o);
    EXPECT_EQ(with_steps(o, choice).integrator, choice.rests ? Integrator::automatic : choice.flow);
    return choice.rests;
  };
  EXPECT_TRUE(rests([](SolveOptions&) {}));
  EXPECT_FALSE(rests([](SolveOptions& o) { o.material.model = MaterialModel::mu_of_i; }));
  EXPECT_FALSE(rests([](SolveOptions& o) { o.deterministic = true; }));
  EXPECT_FALSE(rests([](SolveOptions& o) { o.energy_budget = true; }));
}

TEST(StepChoice, is_carried_out_to_the_last_key) {
  SolveOptions o = chosen_at(0.01);
  const StepChoice choice = steps_of(slab_on_layers(1), o);
  o = with_steps(o, choice);
  EXPECT_EQ(o.flow, choice.flow);
  EXPECT_EQ(o.flow_integrator(), choice.flow);
  EXPECT_EQ(o.cfl, choice.cfl);
}

TEST(StepChoice, what_a_stiffness_went_by_is_not_asked_for_again) {
  // The used recipe names accuracy and the modulus; a strain beside accuracy would be refused.
  SolveOptions o = chosen_at(0.01);
  o.material.stiffness = StiffnessKind::automatic;
  o.material.stiffness_strain = strain_for(0.01);
  o = with_stiffness(o, lowest_stiffness(o, begun(slab_on_layers(1), o).bound));
  std::vector<Fault> faults;
  recipe::find_unmet(o, faults);
  EXPECT_TRUE(faults.empty());
}

TEST(StepChoice, is_settled_from_the_recipe_in_two_steps) {
  SolveOptions o = chosen_at(0.01);
  o.material.youngs_modulus = 1e12;
  const Domain d = slab_on_layers(1);
  Plan plan = begun(d, o);
  std::vector<std::string> reasons;
  const SolveOptions soft = settle_stiffness(o, plan.bound, reasons);
  settle(plan);
  const SolveOptions& settled = plan.options;
  EXPECT_LT(soft.material.youngs_modulus, 1e12);
  EXPECT_EQ(soft.accuracy, o.accuracy) << "the recipe as used asks for it again";
  EXPECT_EQ(settled.flow, steps_of(d, soft).flow);
  EXPECT_FALSE(settled.accuracy);
  o.integrator = Integrator::explicit_;
  o.accuracy.reset();
  EXPECT_EQ(settle_stiffness(o, plan.bound, reasons).material.youngs_modulus, 1e12);
  EXPECT_EQ(settle_steps(d, o, plan.bound, reasons).integrator, Integrator::explicit_);
}

/// A slope that eases from 35 degrees to a level over 400 m; on its upper end a slab of 80 x 40 m (20 m: four layers).
Domain slope(double thickness) {
  constexpr double foot = 400;
  Domain d =
      ground(80, 12, 10, 5, [](double x, double) { return x < foot ? 0.35 * (foot - x) * (foot - x) / foot : 0.0; });
  release(d, {6, 14}, {4, 8}, thickness);
  fill(d, {60, 140, 40, 80, 0, thickness});
  return d;
}

SolveOptions sliding(double modulus) {
  SolveOptions o;
  o.material.youngs_modulus = modulus;
  o.material.stiffness = StiffnessKind::automatic;
  o.material.cone = Cone::compression;
  o.base.friction_angle = 20;
  o.end_time = 20;
  return o;
}

TEST(Stiffness, follows_the_energy_line_of_the_scene) {
  const Domain d = slope(5);
  const SpeedBound bound = begun(d, sliding(1e9)).bound;
  const double speed = bound.speed;
  const StiffnessDemand demand = lowest_stiffness(sliding(1e9), bound);
  // Ground 0.35 (400 - x)^2 / 400 and an energy line that falls by tan 20: furthest apart where both are as steep.
  const auto height = [](double x) { return 0.35 * (400 - x) * (400 - x) / 400; };
  const double mu = std::tan(20 * std::numbers::pi / 180), x = 400 - mu * 400 / 0.7;
  const double head = height(65) + 5 - height(x) - mu * (x - 65);
  EXPECT_NEAR(speed, std::sqrt(2 * 9.81 * head), 0.01 * speed);
  const double confined = 0.75 / (1.25 * 0.5);
  EXPECT_NEAR(demand.modulus, 2000 * speed * speed / 0.02 / confined, 1e-6 * demand.modulus);
  EXPECT_NE(demand.reason.find("dynamic pressure"), std::string::npos) << demand.reason;
  SolveOptions finer = sliding(1e9);
  finer.material.stiffness_strain = 0.08;
  EXPECT_NEAR(lowest_stiffness(finer, begun(d, finer).bound).modulus, demand.modulus / 4, 1e-6 * demand.modulus);
}

TEST(Stiffness, carries_the_weight_of_a_deep_release) {
  Domain d = slope(20);
  for (double& t : d.release_thickness.values) t *= 15;
  const StiffnessDemand demand = lowest_stiffness(sliding(1e10), begun(d, sliding(1e10)).bound);
  EXPECT_LT(2000 * 9.81 * 300 / (1.2 * demand.modulus), 0.01);
}

/// A column as high as it is wide hardly falls: its own weight decides.
TEST(Stiffness, leaves_a_column_its_height) {
  Domain d = ground(40, 40, 0.1, 0.1, flat);
  release(d, {18, 22}, {18, 22}, 0.4);
  fill(d, {1.8, 2.2, 1.8, 2.2, 0, 0.4});
  for (const double accuracy : {0.05, 0.02, 0.01}) {
    SolveOptions o = chosen_at(accuracy);
    o.material.youngs_modulus = 1e9;
    std::vector<std::string> reasons;
    const SolveOptions soft = settle_stiffness(o, begun(d, o).bound, reasons);
    const double confined = make_material<double>(soft.material).wave_speed;
    EXPECT_LE(9.81 * 0.375 / (confined * confined), 0.5 * accuracy * (1 + 1e-9));
    EXPECT_LT(soft.material.youngs_modulus, 1e9);
    ASSERT_FALSE(reasons.empty());
    EXPECT_NE(reasons[0].find("the weight of 0.375 m"), std::string::npos) << "its highest points: " << reasons[0];
  }
}

TEST(Stiffness, is_never_more_than_the_recipe_gives) {
  const StiffnessDemand demand = lowest_stiffness(sliding(1e6), begun(slope(20), sliding(1e6)).bound);
  EXPECT_EQ(demand.modulus, 1e6);
  EXPECT_NE(demand.reason.find("no more than is needed"), std::string::npos) << demand.reason;
}

TEST(Stiffness, of_an_elastic_body_is_its_own) {
  SolveOptions o = sliding(1e9);
  std::vector<Fault> faults;
  recipe::find_unmet(o, faults);
  EXPECT_TRUE(faults.empty());
  o.material.model = MaterialModel::hencky;
  recipe::find_unmet(o, faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].what.find("stiffness = \"auto\""), std::string::npos) << faults[0].what;
  EXPECT_NE(faults[0].mend.find("drucker-prager"), std::string::npos) << faults[0].mend;
}

class StiffnessRuns : public InEachPlace {};
TEST_P(StiffnessRuns, leave_the_deposit_where_it_was) {
  const Domain d = slope(20);
  const auto deposit = [&](const SolveOptions& o) {
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    solver->set_next_event(o.end_time);
    while (solver->clock().time < o.end_time) EXPECT_NE(solver->advance().clock.alarms.halt, failed);
    return std::pair{solver->thickness(), solver->clock().step};
  };
  SolveOptions full = sliding(1e9);
  full.material.stiffness = StiffnessKind::as_given;
  const StiffnessDemand demand = lowest_stiffness(full, begun(d, full).bound);
  const auto [stiff, many] = deposit(full);
  const auto [soft, few] = deposit(with_stiffness(full, demand));
  double way_stiff = 0, way_soft = 0;
  for (std::size_t n = 0; n < soft.size(); ++n) {
    const double from_start = d.grid.x(static_cast<int>(n) % d.grid.columns) - 100;
    way_stiff += stiff[n] * from_start;
    way_soft += soft[n] * from_start;
  }
  EXPECT_NEAR(way_soft, way_stiff, 0.01 * way_stiff);
  EXPECT_LT(share_elsewhere(soft, stiff), 0.02);
  EXPECT_LT(few * 3, many);
}
TALUS_IN_EACH_PLACE(StiffnessRuns);

}  // namespace
}  // namespace talus::solver::testing
