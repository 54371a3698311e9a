// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of an error budget: each is the run that it would be by hand, and a block on an incline moves as Newton's
// law says that the doubt of its friction moves it.
#include <cmath>
#include <numbers>

#include "solver/budget/own_changes.hpp"
#include "solver/budget/run_variations.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/plan/step_choice.hpp"
#include "solver/plan/stiffness.hpp"
#include "solver/run/simulation.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

/// A scene with its budget; domains of their own are left out.
struct BudgetScene {
  test::Scratch scratch;
  recipe::Recipe recipe;
  Domain domain;
  BudgetBase base;
  BudgetOptions options;

  BudgetScene(const std::string& text, Domain made)
      : recipe(scratch.write("recipe.toml", text)), domain(std::move(made)), options(budget_of(recipe)) {
    base.asked = options_of(recipe, scratch.folder());
    base.settled = settled(base.asked);
  }

  SolveOptions settled(const SolveOptions& asked) const {
    Plan plan = begun(domain, asked);
    settle(plan);
    return plan.options;
  }

  std::vector<Variation> variations() const {
    std::vector<Variation> found = variations_of(domain, base, options);
    std::erase_if(found, [](const Variation& one) { return !one.run.domain.empty(); });
    for (Variation& one : own_changes(recipe, scratch.folder(), base, options)) found.push_back(std::move(one));
    return found;
  }

  Budget run(const std::vector<Variation>& variations, On on, int at_a_time = 2) const {
    Budget budget;
    for (const Variation& one : variations) budget.runs.push_back(one.run);
    std::vector<AnyDevice> devices;
    for (int k = 0; k < at_a_time; ++k) devices.push_back(make_device(on));
    EXPECT_TRUE(
        run_variations(variations, budget, {std::make_shared<const Domain>(domain), {scratch.folder()}, devices}));
    return budget;
  }
};

// The name is no std::string: GCC 13 takes a reference that comes of a temporary one for one to it.
const BudgetRun& named(const Budget& budget, const char* name) {
  for (const BudgetRun& run : budget.runs)
    if (run.name == name) return run;
  throw std::logic_error(std::string("no run ") + name);
}

std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n)
    if (!(a[n] == b[n] || (std::isnan(a[n]) && std::isnan(b[n])))) ++count;
  return count;
}

/// Every run of the budget beside the run of the recipe with its values, on all threads: the same bits.
void expect_runs_by_hand(const BudgetScene& scene, On on) {
  const Budget budget = scene.run(scene.variations(), on);
  for (const BudgetRun& run : budget.runs) {
    SCOPED_TRACE(run.name);
    ASSERT_EQ(run.state, BudgetState::done) << run.reason;
    const SolveOptions asked = options_of(scene.recipe.with(run.values), scene.scratch.folder());
    const SolveOptions by_hand = scene.settled(asked);
    const auto folder = scene.scratch / run.name;
    std::filesystem::create_directories(folder);
    const RunPaths files(folder);
    Simulation(drafted(scene.domain, by_hand), make_device(on), files, "").run("heap", "heap");
    const talus::Run alone = read_run(files.run);
    EXPECT_EQ(differing(run.deposit.values, alone.maps.deposit_thickness), 0u);
    EXPECT_EQ(differing(run.peak_thickness.values, alone.maps.peak_thickness), 0u);
    EXPECT_EQ(run.result.steps, static_cast<double>(alone.summary.steps));
  }
}

class BudgetRuns : public InEachPlace {};

TEST_P(BudgetRuns, are_the_runs_that_the_recipe_makes_with_their_values) {
  const BudgetScene scene(heap_recipe(), small_heap());
  std::vector<std::string> names;
  for (const Variation& one : scene.variations()) names.push_back(one.run.name);
  EXPECT_EQ(names, (std::vector<std::string>{"step", "modulus", "integrator", "transfer", "friction-less",
                                             "friction-more", "strength-less", "strength-more"}));
  expect_runs_by_hand(scene, GetParam());
}

TEST_P(BudgetRuns, name_what_the_program_settled_for_the_run_itself) {
  const BudgetScene scene(heap_recipe("integrator = \"auto\"\ncfl = 0.4\n[budget]\nleave_out = [\"strength\"]\n"),
                          small_heap());
  ASSERT_NE(scene.base.settled.integrator, Integrator::automatic);
  EXPECT_EQ(scene.variations().front().run.values.front(), scene.base.settled.integrator == Integrator::explicit_
                                                               ? "solve.integrator=explicit"
                                                               : "solve.integrator=column-implicit");
  expect_runs_by_hand(scene, GetParam());
}

TEST_P(BudgetRuns, do_not_depend_on_how_many_run_at_a_time) {
  const BudgetScene scene(heap_recipe(), small_heap());
  const std::vector<Variation> variations = scene.variations();
  const Budget one = scene.run(variations, GetParam(), 1), four = scene.run(variations, GetParam(), 4);
  for (std::size_t n = 0; n < one.runs.size(); ++n)
    EXPECT_EQ(differing(one.runs[n].deposit.values, four.runs[n].deposit.values), 0u) << one.runs[n].name;
}

TEST_P(BudgetRuns, that_fail_are_named_with_their_reason) {
  // A hundredth of the modulus is so soft that the weight alone would squash the heap: implausible.
  const BudgetScene scene(heap_recipe("") + "[budget]\nmodulus_factor = 0.01\n", small_heap());
  const Budget budget = scene.run(scene.variations(), GetParam());
  const BudgetRun& soft = named(budget, "modulus");
  EXPECT_EQ(soft.state, BudgetState::failed);
  EXPECT_NE(soft.reason.find("weight"), std::string::npos) << soft.reason;
  EXPECT_TRUE(soft.deposit.values.empty());
  EXPECT_EQ(budget.count(BudgetState::done), budget.runs.size() - 1);
}

TEST_P(BudgetRuns, keep_what_they_alone_were_insisted_on) {
  const BudgetScene scene(
      heap_recipe("accept = [\"weight-strain\", \"slow-waves\"]\n") + "[budget]\nmodulus_factor = 0.01\n",
      small_heap());
  const Budget budget = scene.run(scene.variations(), GetParam());
  const BudgetRun& soft = named(budget, "modulus");
  ASSERT_EQ(soft.state, BudgetState::done) << soft.reason;
  EXPECT_NE(fact(soft.accepted, "accepted.weight-strain"), "");
  EXPECT_TRUE(named(budget, "step").accepted.empty()) << "its stiffness is that of the run";
  EXPECT_TRUE(soft.warnings.empty()) << "what is insisted on is said once: " << soft.warnings.front();
}

// A block of strong ground slides to rest on an incline: s = v^2 cos(slope) / 2 g (mu cos(slope) - sin(slope)).
constexpr double degree = std::numbers::pi / 180, gravity = 9.81;
constexpr double slope = 10 * degree, start_speed = 5, friction_deg = 25;

double block_way(double mu) {
  return start_speed * start_speed * std::cos(slope) / (2 * gravity * (mu * std::cos(slope) - std::sin(slope)));
}

std::string block_recipe() {
  const double across = start_speed * std::cos(slope), down = -start_speed * std::sin(slope);
  return "[solve]\nend_time_s = 3.0\nintegrator = \"column-implicit\"\ninitial_velocity_m_s = [" +
         std::to_string(across) + ", 0.0, " + std::to_string(down) +
         "]\n[solve.material]\nfriction_angle_deg = 40.0\ncohesion_Pa = 1e6\nyoungs_modulus_Pa = 1e8\n"
         "[solve.base]\nlaw = \"coulomb\"\nfriction_angle_deg = 25.0\n[budget]\nfriction_doubt = 0.1\n";
}

Domain block() {
  Domain d = ground(28, 8, 1.0, 1.0, [](double x, double) { return 100 - std::tan(slope) * x; });
  fill(d, {6, 10, 2, 6, 0, 1});
  return d;
}

TEST_P(BudgetRuns, move_a_block_as_far_as_the_doubt_of_its_friction_does) {
  const BudgetScene scene(block_recipe(), block());
  const auto own = run_member(drafted(scene.domain, scene.base.settled), make_device(GetParam()));
  ASSERT_TRUE(own);
  const double way = own->result.centre_travel, mu = std::tan(friction_deg * degree);
  const Budget budget = scene.run(scene.variations(), GetParam());
  const auto change = [&](const char* name) { return named(budget, name).result.centre_travel - way; };
  std::printf("  way %.4f m (%.4f), less %.4f (%.4f), more %.4f (%.4f), step %.5f, modulus %.5f\n", way, block_way(mu),
              change("friction-less"), block_way(0.9 * mu) - block_way(mu), change("friction-more"),
              block_way(1.1 * mu) - block_way(mu), change("step"), change("modulus"));
  // The block's way is within 0.08 % of the rigid one's; a change is a difference of two such ways.
  EXPECT_NEAR(way, block_way(mu), 1e-3 * way);
  EXPECT_NEAR(change("friction-less"), block_way(0.9 * mu) - block_way(mu), 1e-3 * way);
  EXPECT_NEAR(change("friction-more"), block_way(1.1 * mu) - block_way(mu), 1e-3 * way);
  // The way of a rigid block depends neither on the step nor on the stiffness: what is left is within its own error.
  for (const char* name : {"step", "modulus", "strength-less", "strength-more"})
    EXPECT_NEAR(change(name), 0, 1e-3 * way) << name;
}

TALUS_IN_EACH_PLACE(BudgetRuns);

/// A recipe of the heap with a run of its own; `more` are lines of [solve].
std::string with_own_run(const std::string& set, const std::string& more = "") {
  return heap_recipe(more) + "[budget]\nleave_out = [\"strength\", \"transfer\", \"integrator\"]\n" +
         "[[budget.run]]\nname = \"voellmy\"\nset = [" + set + "]\n";
}

TEST_P(BudgetRuns, of_the_recipes_own_are_the_runs_with_what_they_set) {
  const std::string law = "'solve.base.law=\"voellmy\"', \"solve.base.turbulence_m_s2=400\"";
  const BudgetScene scene(with_own_run(law), small_heap());
  const Variation own = scene.variations().back();
  EXPECT_EQ(own.run.row, "own");
  EXPECT_EQ(own.options.base.law, FrictionLaw::voellmy);
  expect_runs_by_hand(scene, GetParam());
}

TEST(BudgetOwnRuns, are_settled_as_the_run_itself_is) {
  const BudgetScene scene(
      with_own_run("\"solve.base.friction_angle_deg=5\"", "integrator = \"auto\"\naccuracy = 0.02\n"), small_heap());
  const SolveOptions own = scene.variations().back().options, &base = scene.base.settled;
  EXPECT_EQ(own.base.friction_angle, 5);
  EXPECT_EQ(own.integrator, base.integrator);
  EXPECT_EQ(own.cfl, base.cfl);
  EXPECT_EQ(own.material.youngs_modulus, base.material.youngs_modulus);
}

TEST(BudgetOwnRuns, that_set_what_cannot_be_are_refused_by_name) {
  for (const char* set :
       {"\"solve.base.colour=5\"", "\"preprocess.grid.spacing_m=5\"", "\"solve.base.friction_angle_deg=95\""}) {
    const BudgetScene scene(with_own_run(set), small_heap());
    try {
      scene.variations();
      FAIL() << set;
    } catch (const RecipeError& error) {
      EXPECT_EQ(std::string(error.what()).find("[[budget.run]] \"voellmy\""), 0u) << error.what();
    }
  }
}

TEST(BudgetVariations, take_a_doubt_in_degrees_in_place_of_a_share) {
  const BudgetScene scene(heap_recipe() + "[budget]\nfriction_doubt_deg = 2.0\n", small_heap());
  std::vector<double> angles;
  for (const Variation& one : scene.variations())
    if (one.run.row == "friction") angles.push_back(one.options.base.friction_angle);
  EXPECT_EQ(angles, (std::vector<double>{10, 14}));
}

TEST(BudgetVariations, change_rasters_of_the_bed_where_they_have_values) {
  Domain domain = small_heap();
  Raster angle{domain.grid, std::vector<double>(domain.grid.count(), 20.0)};
  angle.values[3] = nan;
  domain.bed.emplace_back("friction_angle_deg", angle);
  const BudgetScene scene(heap_recipe(), domain);
  for (const Variation& one : scene.variations()) {
    const Domain other = *domain_of(one, std::make_shared<const Domain>(scene.domain), {scene.scratch.folder()});
    const double of_map = other.bed[0].second.values[5];
    const double expected = one.run.name == "friction-less"   ? std::atan(0.9 * std::tan(20 * degree)) / degree
                            : one.run.name == "friction-more" ? std::atan(1.1 * std::tan(20 * degree)) / degree
                                                              : 20.0;
    EXPECT_NEAR(of_map, expected, 1e-12) << one.run.name;
    EXPECT_TRUE(std::isnan(other.bed[0].second.values[3])) << "the recipe's number holds there";
  }
}

TEST(BudgetVariations, are_those_of_the_law_of_the_bed) {
  const auto names_of = [](const std::string& bed) {
    std::string text = heap_recipe();
    text.replace(text.find("law = "), std::string::npos, bed + "[budget]\nleave_out = [\"strength\", \"transfer\"]\n");
    const BudgetScene scene(text, small_heap());
    std::string names;
    for (const Variation& one : scene.variations()) names += one.run.name + " ";
    return names;
  };
  EXPECT_EQ(names_of("law = \"voellmy\"\n"),
            "step modulus integrator friction-less friction-more drag-less drag-more ");
  EXPECT_EQ(names_of("law = \"velocity-weakening\"\n"),
            "step modulus integrator friction-less friction-more weakening-rest weakening-fast ");
  EXPECT_EQ(names_of("law = \"stick\"\n"), "step modulus integrator ");
}

TEST(BudgetVariations, leave_out_what_the_recipe_does_not_allow) {
  const BudgetScene scene(heap_recipe() + "[[solve.wall]]\naxis = \"z\"\nposition_m = 100\nmaterial_is = \"below\"\n",
                          small_heap());
  bool found = false;
  for (const Variation& one : scene.variations()) {
    if (one.run.name != "integrator") continue;
    found = true;
    EXPECT_EQ(one.run.state, BudgetState::left_out);
    EXPECT_NE(one.run.reason.find("column-implicit"), std::string::npos) << one.run.reason;
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace talus::solver::testing
