// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of an error budget: each is the run that it would be by hand, and a block on an incline moves as Newton's
// law says that the doubt of its friction moves it.
#include <sstream>

#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/run_members.hpp"
#include "solver/ensemble/variations.hpp"
#include "solver/run/simulation.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

const std::string budget_table = "[ensemble]\ndesign = \"budget\"\n[ensemble.budget]\n";

/// A scene with its budget, without members that have domains of their own.
struct BudgetScene {
  test::Scratch scratch;
  recipe::Recipe recipe;
  std::shared_ptr<const Domain> domain;
  EnsembleOptions options;
  MemberTable table;
  SolveOptions asked;
  Members members;

  BudgetScene(const std::string& text, Domain made)
      : recipe(scratch.write("recipe.toml", text)),
        domain(std::make_shared<const Domain>(std::move(made))),
        options(ensemble_of(recipe)),
        table(members_in(options.budget)),
        asked(options_of(recipe, scratch.folder())),
        members(recipe, table, {scratch.folder()}, domain, asked) {}

  static MemberTable members_in(const BudgetOptions& budget) {
    MemberTable table;
    for (const BudgetMember& member : budget_members(budget)) {
      if (member.row == "cells" || member.row == survey_row) continue;
      table.names.push_back(member.name);
      table.rows.push_back(member.row);
    }
    table.count = static_cast<std::int64_t>(table.names.size());
    table.own_domain.assign(table.names.size(), 0);
    return table;
  }

  SolveOptions settled(const SolveOptions& from) const {
    Plan plan = begin_plan(domain, from);
    settle(plan);
    return plan.options;
  }

  /// Counts with what members change, and those left out that are not to be run.
  EnsembleCounts noted() const {
    EnsembleScene scene;
    scene.grid = domain->grid;
    scene.threshold = *with_map_threshold(asked, *domain).map_threshold;
    EnsembleCounts counts = empty_counts(std::move(scene), table.count, {0, table.count}, {});
    members.note_changes(counts);
    return counts;
  }

  EnsembleCounts run(On on, int at_a_time = 2) const {
    EnsembleCounts counts = noted();
    EXPECT_TRUE(run_members(members, counts, {.devices = devices_for(at_a_time, on)}));
    return counts;
  }

  std::size_t place(const std::string& name) const {
    return static_cast<std::size_t>(std::find(table.names.begin(), table.names.end(), name) - table.names.begin());
  }
  SolveOptions options_named(const std::string& name) const {
    return members.plan(static_cast<std::int64_t>(place(name)))->options;
  }

  /// The names of the members that are run, but for the recipe itself.
  std::string names() const {
    const EnsembleCounts counts = noted();
    std::string all;
    for (std::size_t k = 1; k < table.names.size(); ++k)
      if (counts.states[k] == MemberState::waiting) all += table.names[k] + " ";
    return all;
  }

  /// The keys that make a member by hand.
  std::vector<std::string> values_of(std::int64_t member) const {
    std::vector<std::string> values;
    for (const MemberWords& change : noted().changes) {
      std::istringstream lines(change.member == member ? change.words : "");
      std::string line;
      std::getline(lines, line);  // in words
      while (std::getline(lines, line))
        if (!line.empty()) values.push_back(line);
    }
    return values;
  }
};

/// Every member beside the run of the recipe with its values, on all threads: the same bits.
void expect_runs_by_hand(const BudgetScene& scene, On on) {
  const EnsembleCounts noted = scene.noted();
  for (std::int64_t k = 0; k < scene.table.count; ++k) {
    SCOPED_TRACE(scene.table.names[static_cast<std::size_t>(k)]);
    if (noted.states[static_cast<std::size_t>(k)] != MemberState::waiting) continue;
    const auto made = run_member(scene.members.plan(k), make_device(on));
    ASSERT_TRUE(made);
    const SolveOptions by_hand =
        scene.settled(options_of(scene.recipe.with(scene.values_of(k)), scene.scratch.folder()));
    const auto folder = scene.scratch / std::to_string(k);
    std::filesystem::create_directories(folder);
    const RunPaths files(folder);
    Simulation(drafted(*scene.domain, by_hand), make_device(on), files, "").run("heap", "heap");
    const talus::Run alone = read_run(files.run);
    EXPECT_EQ(differing(made->maps.deposit_thickness, alone.maps.deposit_thickness), 0u);
    EXPECT_EQ(differing(made->maps.peak_thickness, alone.maps.peak_thickness), 0u);
    EXPECT_EQ(made->result.steps, static_cast<double>(alone.summary.steps));
  }
}

class BudgetRuns : public InEachPlace {};
TALUS_IN_EACH_PLACE(BudgetRuns);

TEST_P(BudgetRuns, are_the_runs_that_the_recipe_makes_with_their_values) {
  const BudgetScene scene(heap_recipe() + budget_table, small_heap());
  EXPECT_EQ(scene.names(),
            "repeat step modulus integrator transfer friction-less friction-more strength-less strength-more ");
  expect_runs_by_hand(scene, GetParam());
}

TEST_P(BudgetRuns, name_what_the_program_settled_for_the_run_itself) {
  const BudgetScene scene(
      heap_recipe("integrator = \"auto\"\ncfl = 0.4\n") + budget_table + "leave_out = [\"strength\"]\n", small_heap());
  const Integrator settled = scene.members.base().integrator;
  ASSERT_NE(settled, Integrator::automatic);
  EXPECT_EQ(scene.values_of(0).front(),
            settled == Integrator::explicit_ ? "solve.integrator=explicit" : "solve.integrator=column-implicit");
  expect_runs_by_hand(scene, GetParam());
}

// A block of strong ground slides to rest on an incline: s = v^2 cos(slope) / 2 g (mu cos(slope) - sin(slope)).
constexpr double friction_deg = 25;

double block_way(double mu) {
  return start_speed * start_speed * std::cos(slope) / (2 * gravity * (mu * std::cos(slope) - std::sin(slope)));
}

TEST_P(BudgetRuns, move_a_block_as_far_as_the_doubt_of_its_friction_does) {
  const BudgetScene scene(
      block_recipe("friction_angle_deg = 40.0\ncohesion_Pa = 1e6\n") + budget_table + "friction_doubt = 0.1\n",
      block_on_the_incline());
  const EnsembleCounts counts = scene.run(GetParam());
  const double way = counts.results.front().centre_travel, mu = std::tan(friction_deg * degree);
  const auto change = [&](const char* name) { return counts.results[scene.place(name)].centre_travel - way; };
  // The block's way is within 0.08 % of the rigid one's; a change is a difference of two such ways.
  EXPECT_NEAR(way, block_way(mu), 1e-3 * way);
  EXPECT_NEAR(change("friction-less"), block_way(0.9 * mu) - block_way(mu), 1e-3 * way);
  EXPECT_NEAR(change("friction-more"), block_way(1.1 * mu) - block_way(mu), 1e-3 * way);
  // The way of a rigid block depends neither on the step nor on the stiffness: what is left is within its own error.
  for (const char* name : {"repeat", "step", "modulus", "strength-less", "strength-more"})
    EXPECT_NEAR(change(name), 0, 1e-3 * way) << name;
}

/// A recipe of the heap with a change of its own; `more` are lines of [solve].
std::string with_own_run(const std::string& set, const std::string& more = "") {
  return heap_recipe(more) + budget_table + "leave_out = [\"strength\", \"transfer\", \"integrator\"]\n" +
         "[[ensemble.budget.run]]\nname = \"voellmy\"\nset = [" + set + "]\n";
}

TEST_P(BudgetRuns, of_the_recipes_own_are_the_runs_with_what_they_set) {
  const std::string law = "'solve.base.law=\"voellmy\"', \"solve.base.turbulence_m_s2=400\"";
  const BudgetScene scene(with_own_run(law), small_heap());
  EXPECT_EQ(scene.table.rows.back(), "own");
  EXPECT_EQ(scene.options_named("voellmy").base.law, FrictionLaw::voellmy);
  expect_runs_by_hand(scene, GetParam());
}

TEST(BudgetOwnRuns, are_settled_as_the_run_itself_is) {
  const BudgetScene scene(
      with_own_run("\"solve.base.friction_angle_deg=5\"", "integrator = \"auto\"\naccuracy = 0.02\n"), small_heap());
  const SolveOptions own = scene.options_named("voellmy"), &base = scene.members.base();
  EXPECT_EQ(own.base.friction_angle, 5);
  EXPECT_EQ(own.integrator, base.integrator);
  EXPECT_EQ(own.cfl, base.cfl);
  EXPECT_EQ(own.material.youngs_modulus, base.material.youngs_modulus);
}

TEST(BudgetOwnRuns, that_set_what_cannot_be_are_refused_by_name) {
  for (const char* set :
       {"\"solve.base.colour=5\"", "\"preprocess.grid.spacing_m=5\"", "\"solve.base.friction_angle_deg=95\""}) {
    const std::string fault =
        test::fault_of<RecipeError>([&] { const BudgetScene scene(with_own_run(set), small_heap()); });
    EXPECT_TRUE(fault.starts_with("[[ensemble.budget.run]] \"voellmy\"")) << set << ": " << fault;
  }
}

TEST(BudgetVariations, change_the_tangent_of_an_angle_by_the_share_in_doubt) {
  const BudgetScene scene(heap_recipe() + budget_table + "friction_doubt = 0.2\n", small_heap());
  const auto tangent = [&](const char* name) {
    return std::tan(scene.options_named(name).base.friction_angle * degree);
  };
  EXPECT_NEAR(tangent("friction-less"), 0.8 * std::tan(12 * degree), 1e-12);
  EXPECT_NEAR(tangent("friction-more"), 1.2 * std::tan(12 * degree), 1e-12);
}

TEST(BudgetVariations, change_rasters_of_the_bed_where_they_have_values) {
  Domain domain = small_heap();
  Raster angle{domain.grid, std::vector<double>(domain.grid.count(), 20.0)};
  angle.values[3] = nan;
  domain.bed.emplace_back("friction_angle_deg", angle);
  const BudgetScene scene(heap_recipe() + budget_table, domain);
  for (const auto& [name, factor] : {std::pair{"recipe", 1.0}, {"friction-less", 0.9}, {"friction-more", 1.1}}) {
    const auto plan = scene.members.plan(static_cast<std::int64_t>(scene.place(name)));
    EXPECT_NEAR(plan->domain->bed[0].second.values[5], std::atan(factor * std::tan(20 * degree)) / degree, 1e-12)
        << name;
    EXPECT_TRUE(std::isnan(plan->domain->bed[0].second.values[3])) << "the recipe's number holds there";
  }
}

TEST(BudgetVariations, are_those_of_the_law_of_the_bed) {
  const auto names_of = [](const std::string& bed) {
    std::string text = heap_recipe();
    text.replace(text.find("law = "), std::string::npos,
                 bed + budget_table + "leave_out = [\"strength\", \"transfer\"]\n");
    return BudgetScene(text, small_heap()).names();
  };
  EXPECT_EQ(names_of("law = \"voellmy\"\n"),
            "repeat step modulus integrator friction-less friction-more drag-less drag-more ");
  EXPECT_EQ(names_of("law = \"velocity-weakening\"\n"),
            "repeat step modulus integrator friction-less friction-more weakening-rest weakening-fast ");
  EXPECT_EQ(names_of("law = \"stick\"\n"), "repeat step modulus integrator ");
}

TEST(BudgetVariations, leave_out_what_the_recipe_does_not_allow) {
  const BudgetScene scene(
      heap_recipe() + "[[solve.wall]]\naxis = \"z\"\nposition_m = 100\nmaterial_is = \"below\"\n" + budget_table,
      small_heap());
  const EnsembleCounts counts = scene.noted();
  EXPECT_EQ(counts.states[scene.place("integrator")], MemberState::left_out);
  ASSERT_EQ(counts.failures.size(), 1u) << "rows that have nothing to change are left out without a word";
  EXPECT_NE(counts.failures[0].words.find("column-implicit"), std::string::npos) << counts.failures[0].words;
}

}  // namespace
}  // namespace talus::solver::testing
