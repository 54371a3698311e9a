// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members of an ensemble are the runs that they would be alone, whoever runs them beside them.
#include "solver/ensemble/run_members.hpp"

#include <numeric>

#include "common/domain/scale_release.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/ensemble/same_maps.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

void expect_same(const std::vector<double>& a, const std::vector<double>& b, const char* name) {
  ASSERT_EQ(a.size(), b.size());
  std::size_t different = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (!(a[n] == b[n] || (std::isnan(a[n]) && std::isnan(b[n])))) ++different;
  EXPECT_EQ(different, 0u) << name;
}

void expect_same(const EnsembleCounts& a, const EnsembleCounts& b) {
  EXPECT_EQ(a.states, b.states);
  test::expect_same_maps(a, b);
  EXPECT_EQ(a.flow, b.flow);
  EXPECT_EQ(a.deposit, b.deposit);
  for (std::size_t k = 0; k < a.results.size(); ++k) {
    EXPECT_EQ(a.results[k].run_out, b.results[k].run_out);
    EXPECT_EQ(a.results[k].steps, b.results[k].steps);
  }
}

class RunMembers : public InEachPlace {};

/// Each member's maps and numbers are those of the recipe with its values, run alone.
void expect_members_as_alone(const SmallEnsemble& ensemble, On on) {
  const Members members = ensemble.members();
  for (std::int64_t k = 0; k < ensemble.table.count; ++k) {
    SCOPED_TRACE(k);
    const auto own = members.plan(k);
    const auto run = run_member(own, make_device(on));
    ASSERT_TRUE(run);
    const RunPaths files(ensemble.scratch / std::to_string(k));
    std::filesystem::create_directories(ensemble.scratch / std::to_string(k));
    // Alone: the recipe with the member's values, on all threads.
    const SolveOptions options =
        options_of(ensemble.recipe.with(ensemble.table.values_of(k, "solve.")), ensemble.scratch.folder());
    Simulation(drafted(*own->domain, options), make_device(on), files, "").run("heap", "heap");
    const talus::Run alone = read_run(files.run);
    for (const MapField& field : map_fields) {
      if (field.optional) continue;
      expect_same(run->maps.*(field.values), alone.maps.*(field.values), field.name);
    }
    EXPECT_EQ(run->result.steps, static_cast<double>(alone.summary.steps));
    EXPECT_EQ(run->result.volume_final, alone.summary.volume_final);
    EXPECT_GT(run->result.run_out, 0);
  }
}

TEST_P(RunMembers, gives_each_member_the_bits_of_its_run_alone) {
  expect_members_as_alone(SmallEnsemble(), GetParam());
}

/// The value that the share `q` of the cells above 0 do not exceed, by sorting them.
double share_of_positive(std::vector<double> values, double q) {
  std::erase_if(values, [](double v) { return !(v > 0); });
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double next = values[std::min(below + 1, values.size() - 1)];
  return values[below] + (place - static_cast<double>(below)) * (next - values[below]);
}

TEST_P(RunMembers, gives_the_99th_percentile_beside_every_largest_value) {
  const SmallEnsemble ensemble;
  const auto run = run_member(ensemble.members().plan(0), make_device(GetParam()));
  ASSERT_TRUE(run);
  const MemberResult& r = run->result;
  EXPECT_DOUBLE_EQ(r.p99_thickness, share_of_positive(run->maps.peak_thickness, 0.99));
  EXPECT_DOUBLE_EQ(r.p99_deposit, share_of_positive(run->maps.deposit_thickness, 0.99));
  EXPECT_DOUBLE_EQ(r.p99_speed, share_of_positive(run->maps.peak_speed, 0.99));
  EXPECT_DOUBLE_EQ(r.p99_pressure, share_of_positive(run->maps.peak_pressure_kPa, 0.99));
  EXPECT_GT(r.p99_speed, 0);
  EXPECT_LT(r.p99_speed, r.largest_speed);
}

TEST_P(RunMembers, lets_in_what_each_member_alone_would_let_in) {
  MemberTable table;
  table.design = "table";
  table.count = 3;
  table.columns = {{"solve.inflow[0].scale", {0.5, 1, 2}, {}}, {"solve.inflow[0].speed_m_s", {3, 4, 4}, {}}};
  table.own_domain.assign(3, 0);
  const SmallEnsemble ensemble(table,
                               "[[solve.inflow]]\nline_m = [[28.0, 5.0], [28.0, 11.0]]\n"
                               "hydrograph = [[0.0, 0.0], [0.5, 12.0], [1.5, 0.0]]\nspeed_m_s = 4.0\n");
  expect_members_as_alone(ensemble, GetParam());
  const Members members = ensemble.members();
  const double heap = 64;
  for (std::int64_t k = 0; k < 3; ++k) {
    const auto own = members.plan(k);
    const auto run = run_member(own, make_device(GetParam()));
    ASSERT_TRUE(run);
    EXPECT_NEAR(run->result.volume_released, heap + 9 * table.columns[0].values[static_cast<std::size_t>(k)], 1e-9);
  }
}

TEST_P(RunMembers, counts_the_same_however_many_run_at_a_time) {
  const SmallEnsemble ensemble;
  const Members members = ensemble.members();
  EnsembleCounts one = ensemble.counts(), four = ensemble.counts();
  EXPECT_TRUE(run_members(members, one, {.devices = devices_for(1, GetParam())}));
  EXPECT_TRUE(run_members(members, four, {.devices = devices_for(4, GetParam())}));
  EXPECT_EQ(one.count(MemberState::counted), 6);
  expect_same(one, four);
}

TEST_P(RunMembers, in_parts_add_up_to_the_bits_of_the_whole) {
  const SmallEnsemble ensemble;
  const Members members = ensemble.members();
  EnsembleCounts whole = ensemble.counts(), first = ensemble.counts({0, 2}), rest = ensemble.counts({2, 6});
  run_members(members, whole, {.devices = devices_for(2, GetParam())});
  run_members(members, rest, {.devices = devices_for(2, GetParam())});
  run_members(members, first, {.devices = devices_for(1, GetParam())});
  const EnsembleCounts sum = merged({rest, first}, {"rest", "first"});
  expect_same(whole, sum);
  EXPECT_GT(whole.maps[0].sum.at(whole.cells.find(20, 8)), 0) << "something was counted";
}

TEST_P(RunMembers, leaves_out_and_names_a_member_that_fails) {
  MemberTable table = small_table();
  // So soft that its own weight would squash it: refused as implausible.
  table.columns.push_back({"solve.material.youngs_modulus_Pa", {1e6, 1e6, 10, 1e6, 1e6, 1e6}, {}});
  const SmallEnsemble ensemble(table);
  EnsembleCounts counts = ensemble.counts();
  const bool is_whole = run_members(ensemble.members(), counts, {.devices = devices_for(2, GetParam())});
  EXPECT_TRUE(is_whole);
  EXPECT_EQ(counts.count(MemberState::counted), 5);
  ASSERT_EQ(counts.failures.size(), 1u);
  EXPECT_EQ(counts.failures[0].member, 2);
  EXPECT_NE(counts.failures[0].words.find("weight"), std::string::npos) << counts.failures[0].words;
  EXPECT_TRUE(counts.flow[2].empty());
}

/// Which of them ends first is a matter of chance.
TEST_P(RunMembers, say_what_the_recipe_insists_on_by_member) {
  MemberTable table = small_table();
  table.columns.push_back({"solve.material.youngs_modulus_Pa", {1e6, 1e6, 2e4, 1e6, 1e4, 1e6}, {}});
  const SmallEnsemble ensemble(table, "accept = [\"weight-strain\", \"slow-waves\"]\n");
  EnsembleCounts counts = ensemble.counts();
  run_members(ensemble.members(), counts, {.devices = devices_for(3, GetParam())});
  const auto found = std::ranges::find(counts.findings, "weight-strain", &Finding::name);
  ASSERT_NE(found, counts.findings.end());
  EXPECT_EQ(found->member, 2);
  EXPECT_EQ(found->severity, Severity::refusal);
  EXPECT_NE(found->message.find("under its own weight"), std::string::npos) << found->message;
}

TEST_P(RunMembers, keeps_what_each_member_warns_of) {
  const SmallEnsemble ensemble(small_table(), "accept = [\"slow-waves\"]\ninitial_velocity_m_s = [150, 0, 0]\n");
  EnsembleCounts counts = ensemble.counts();
  run_members(ensemble.members(), counts, {.devices = devices_for(2, GetParam())});
  ASSERT_EQ(counts.count(MemberState::counted), 6);
  for (std::int64_t k = 0; k < 6; ++k)
    EXPECT_TRUE(std::ranges::any_of(
        counts.findings, [&](const Finding& one) { return one.member == k && one.name == "volume-left-domain"; }))
        << "member " << k;
}

TEST_P(RunMembers, leaves_out_a_member_whose_scene_the_recipe_does_not_suit) {
  // Half as thick, the third has no point in the load's box.
  MemberTable table = small_table();
  table.columns.back().values = {1, 1, 0.5, 1, 1, 1};
  const SmallEnsemble ensemble(table, "[[solve.load]]\nextent_m = [18, 4, 26, 12, 0.6, 1]\nforce_N = [10, 0, 0]\n");
  EnsembleCounts counts = ensemble.counts();
  run_members(ensemble.members(), counts, {.devices = devices_for(2, GetParam())});
  EXPECT_EQ(counts.count(MemberState::counted), 5);
  ASSERT_EQ(counts.failures.size(), 1u);
  EXPECT_EQ(counts.failures[0].member, 2);
  EXPECT_NE(counts.failures[0].words.find("[[solve.load]] number 1"), std::string::npos) << counts.failures[0].words;
}

TEST_P(RunMembers, leaves_out_a_member_whose_domain_could_not_be_made) {
  MemberTable table = small_table();
  table.own_domain[4] = 1;
  table.failures = {{4, "the source is empty"}};
  const SmallEnsemble ensemble(table);
  EnsembleCounts counts = ensemble.counts();
  run_members(ensemble.members(), counts, {.devices = devices_for(2, GetParam())});
  EXPECT_EQ(counts.count(MemberState::counted), 5);
  EXPECT_EQ(counts.failures, (std::vector<MemberWords>{{4, "the source is empty"}}));
}

TEST(Members, scale_the_release_of_domains_of_their_own_too) {
  MemberTable table = small_table();
  table.own_domain[1] = 1;  // its factor is 0.8
  const SmallEnsemble ensemble(table);
  std::filesystem::create_directories(ensemble.paths.folder());
  Domain own = small_heap();
  for (double& z : own.terrain.values) z += 3;
  for (double& z : own.before.values) z += 3;
  write_domain(ensemble.paths.domain(1), own);
  const Members members = ensemble.members();
  const auto volume = [](const Domain& d) {
    return std::accumulate(d.points.volume.begin(), d.points.volume.end(), 0.0);
  };
  EXPECT_NEAR(volume(*members.plan(1)->domain), 0.8 * volume(own), 1e-9 * volume(own));
  EXPECT_NEAR(volume(*members.plan(2)->domain), 1.25 * volume(ensemble.domain), 1e-9 * volume(own));
  EXPECT_EQ(members.plan(1)->domain->terrain.values, own.terrain.values);
  const auto thick = [&] {
    Domain scaled = read_domain(ensemble.paths.domain(1));  // its mask names the cells around its own points
    scale_release(scaled, 5);
    return make_scene(scaled, ensemble.base).points.size();
  };
  EXPECT_EQ(thick(), own.points.size()) << "points above the layers that they were seeded in";
  own.grid.west += 1;
  own.terrain.grid = own.before.grid = own.release_thickness.grid = own.grid;
  write_domain(ensemble.paths.domain(1), own);
  EXPECT_THROW(members.plan(1), DataError) << "maps of another grid cannot be added up";
}

TEST(Members, name_the_member_that_the_recipe_does_not_allow) {
  MemberTable table = small_table();
  table.columns[0].values[3] = 95;
  const SmallEnsemble ensemble(table);
  const Members members = ensemble.members();
  try {
    members.check();
    FAIL() << "95 degrees are allowed";
  } catch (const RecipeError& error) {
    EXPECT_EQ(std::string(error.what()).find("member 3: "), 0u) << error.what();
  }
}

TEST(Members, settle_what_is_left_to_the_program_once) {
  MemberTable table = small_table();
  table.columns = {{"solve.base.friction_angle_deg", {8, 10, 12, 14, 16, 18}, {}}};
  const SmallEnsemble ensemble(table, "integrator = \"auto\"\naccuracy = 0.02\n");
  const Members members = ensemble.members();
  EXPECT_FALSE(members.settles_each());
  const SolveOptions first = members.plan(0)->options, last = members.plan(5)->options;
  EXPECT_EQ(first.material.youngs_modulus, last.material.youngs_modulus);
  EXPECT_EQ(first.flow_integrator(), last.flow_integrator());
  EXPECT_EQ(first.cfl, last.cfl);
  EXPECT_NE(first.base.friction_angle, last.base.friction_angle);
}

TALUS_IN_EACH_PLACE(RunMembers);

}  // namespace
}  // namespace talus::solver::testing
