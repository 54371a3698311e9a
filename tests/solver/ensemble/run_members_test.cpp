// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members of an ensemble are the runs that they would be alone, whoever runs beside them, and how many do.
#include <numeric>
#include <set>
#include <thread>

#include "common/domain/domain.hpp"
#include "common/stage/machine.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/run_members.hpp"
#include "solver/plan/describe_plan.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

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

/// All members of an ensemble, some at a time.
EnsembleCounts counted(const SmallEnsemble& ensemble, On on, int at_a_time = 2) {
  EnsembleCounts counts = ensemble.counts();
  EXPECT_TRUE(run_members(ensemble.members(), counts, {.devices = devices_for(at_a_time, on)}));
  return counts;
}

void expect_failure_of_the_third(const EnsembleCounts& counts, const std::string& words) {
  EXPECT_EQ(counts.count(MemberState::counted), 5);
  ASSERT_EQ(counts.failures.size(), 1u);
  EXPECT_EQ(counts.failures[0].member, 2);
  EXPECT_NE(counts.failures[0].words.find(words), std::string::npos) << counts.failures[0].words;
}

class RunMembers : public InEachPlace {};
TALUS_IN_EACH_PLACE(RunMembers);

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
    // Alone: the recipe with the member's values, on all threads. All members count from one thickness, the recipe's.
    SolveOptions options =
        options_of(ensemble.recipe.with(ensemble.table.values_of(k, "solve.")), ensemble.scratch.folder());
    options.map_threshold = with_map_threshold(ensemble.base, ensemble.domain).map_threshold;
    Simulation(drafted(*own->domain, options, Settle::as_asked), make_device(on), files, "").run("heap", "heap");
    const talus::Run alone = read_run(files.run);
    for (const MapField& field : map_fields) {
      if (field.optional) continue;
      EXPECT_EQ(differing(run->maps.*(field.values), alone.maps.*(field.values)), 0u) << field.name;
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

TEST_P(RunMembers, measures_at_gauges_what_the_maps_hold_there) {
  const SmallEnsemble ensemble(small_table(), "[[solve.gauge]]\nname = \"foot\"\nat_m = [16.4, 8.3]\n");
  const auto run = run_member(ensemble.members().plan(0), make_device(GetParam()));
  ASSERT_TRUE(run);
  const std::size_t cell = run->maps.grid.index(16, 8);
  const auto& at = run->result.at_gauges;
  ASSERT_EQ(at.size(), std::size(gauge_numbers));
  EXPECT_EQ(at.at("gauge_foot_arrival_s"), run->maps.arrival_time[cell]);
  EXPECT_EQ(at.at("gauge_foot_peak_thickness_m"), run->maps.peak_thickness[cell]);
  EXPECT_EQ(at.at("gauge_foot_peak_speed_m_s"), run->maps.peak_speed[cell]);
  EXPECT_EQ(at.at("gauge_foot_peak_pressure_kPa"), run->maps.peak_pressure_kPa[cell]);
  EXPECT_GT(at.at("gauge_foot_peak_thickness_m"), 0);
}

TEST_P(RunMembers, lets_in_what_each_member_alone_would_let_in) {
  const MemberTable table{
      .design = "table",
      .count = 3,
      .columns = {{"solve.inflow[0].scale", {0.5, 1, 2}, {}}, {"solve.inflow[0].speed_m_s", {3, 4, 4}, {}}},
      .own_domain = {0, 0, 0}};
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
  const EnsembleCounts one = counted(ensemble, GetParam(), 1), four = counted(ensemble, GetParam(), 4);
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
  const EnsembleCounts counts = counted(ensemble, GetParam());
  expect_failure_of_the_third(counts, "weight");
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
  const EnsembleCounts counts = counted(ensemble, GetParam());
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
  const EnsembleCounts counts = counted(ensemble, GetParam());
  expect_failure_of_the_third(counts, "[[solve.load]] number 1");
}

TEST_P(RunMembers, leaves_out_a_member_whose_domain_could_not_be_made) {
  MemberTable table = small_table();
  table.own_domain[4] = 1;
  table.failures = {{4, "the source is empty"}};
  const SmallEnsemble ensemble(table);
  const EnsembleCounts counts = counted(ensemble, GetParam());
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
  const std::string fault = test::fault_of<RecipeError>([&] { members.check(); });
  EXPECT_TRUE(fault.starts_with("member 3: ")) << fault;
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

/// What a recipe may ask for beside the heap.
struct Asked {
  std::string name;
  std::string lines;                                        ///< of [solve]
  std::vector<std::pair<std::string, std::string>> values;  ///< of keys of [solve], by name
};

const std::vector<Asked> everything_asked{
    {"nothing", "", {}},
    {"single_precision", "", {{"solve.precision", "single"}}},
    {"columns", "integrator = \"column-implicit\"\n", {}},
    {"columns_in_single_precision", "integrator = \"column-implicit\"\n", {{"solve.precision", "single"}}},
    {"steps_that_are_chosen", "integrator = \"auto\"\naccuracy = 0.02\n", {}},
    {"increments", "stress_update = \"musl\"\n", {{"solve.transfer", "flip"}}},
    {"no_finer_velocity", "transfer_time_s = 0.0\n", {}},
    {"damping", "damping = 0.1\n", {}},
    {"averaged_functions", "", {{"solve.shape", "gimp"}}},
    {"hats", "", {{"solve.shape", "linear"}}},
    {"level_layers", "mapping = \"cartesian\"\n", {}},
    {"energy_budget", "energy_budget = true\n", {}},
    {"obstacle", "[[solve.obstacle]]\nname = \"wall\"\nlevel_set = \"wall.vdb\"\n", {}},
    {"wall", "[[solve.wall]]\naxis = \"x\"\nposition_m = 14.0\n", {}},
    {"gate", "[[solve.wall]]\naxis = \"x\"\nposition_m = 17.0\nto_s = 0.7\n", {}},
    {"load", "[[solve.load]]\nextent_m = [18, 4, 26, 12, 0, 1]\nforce_N = [1e4, 0, 0]\n", {}},
    {"gauge", "[[solve.gauge]]\nname = \"g\"\nat_m = [20.0, 8.0]\n", {}},
    {"voellmy", "", {{"solve.base.law", "voellmy"}}},
    {"weakening", "", {{"solve.base.law", "velocity-weakening"}}},
    {"pouliquen", "", {{"solve.base.law", "pouliquen"}}},
    {"elastic", "", {{"solve.material.model", "neo-hookean"}}},
    {"grains", "", {{"solve.material.model", "mu-of-i"}}},
    {"mud", "", {{"solve.material.model", "herschel-bulkley"}}},
};

/// Members that all ask for it, with friction of their own.
MemberTable table_of(const Asked& asked) {
  MemberTable table{.design = "table",
                    .count = 4,
                    .columns = {{"solve.base.friction_angle_deg", {8, 10, 12, 14}, {}}},
                    .own_domain = {0, 0, 0, 0}};
  for (const auto& [key, name] : asked.values) table.columns.push_back({key, {0, 0, 0, 0}, {name}});
  return table;
}

/// The wall that the heap meets where it asks for one.
void write_wall(const std::filesystem::path& file) {
  const auto distance = [](double x, double y, double z) {
    return std::max({14 - x, x - 15.5, 6 - y, y - 10, 2 - z, z - 8});
  };
  write_level_sets(file, {{"wall", {14, 6, 2}, {15.5, 10, 8}, distance}}, 0.25);
}

class SeveralAtATime : public InEachPlace {};
TALUS_IN_EACH_PLACE(SeveralAtATime);

/// On a GPU sums come in any order, so that equal runs differ by rounding, which grows as the mass slides.
TEST_P(SeveralAtATime, give_what_one_at_a_time_gives) {
  const double tolerance = GetParam() == On::cpu ? 0 : 1e-3;
  for (const Asked& asked : everything_asked) {
    SCOPED_TRACE(asked.name);
    const SmallEnsemble ensemble(table_of(asked), asked.lines, /*deterministic=*/false);
    write_wall(ensemble.scratch / "wall.vdb");
    const EnsembleCounts one = counted(ensemble, GetParam(), 1), four = counted(ensemble, GetParam(), 4);
    for (const EnsembleCounts* counts : {&one, &four})
      for (const MemberWords& failure : counts->failures) ADD_FAILURE() << failure.words;
    for (std::size_t k = 0; k < 4; ++k) {
      SCOPED_TRACE(k);
      const MemberResult &a = one.results[k], &b = four.results[k];
      EXPECT_GT(a.steps, 20);
      EXPECT_NEAR(b.steps, a.steps, tolerance * a.steps);
      EXPECT_NEAR(b.volume_final, a.volume_final, tolerance * a.volume_final);
      EXPECT_NEAR(b.p99_speed, a.p99_speed, tolerance * a.p99_speed);
      EXPECT_NEAR(b.p99_deposit, a.p99_deposit, tolerance * a.p99_deposit);
    }
  }
}

std::vector<AnyDevice> cpus(int count) {
  std::vector<AnyDevice> devices;
  for (int k = 0; k < count; ++k) devices.push_back(make_device(On::cpu));
  return devices;
}

TEST(SideBySide, takes_every_place_once_on_all_devices) {
  std::mutex mutex;
  std::multiset<std::size_t> taken;
  std::set<const AnyDevice*> used;
  const std::vector<AnyDevice> devices = cpus(3);
  side_by_side(50, devices, [&](std::size_t place, const AnyDevice& device) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard<std::mutex> one(mutex);
    taken.insert(place);
    used.insert(&device);
  });
  EXPECT_EQ(taken.size(), 50u);
  EXPECT_EQ(std::set<std::size_t>(taken.begin(), taken.end()).size(), 50u);
  EXPECT_EQ(used.size(), 3u);
}

TEST(SideBySide, begins_no_more_once_a_call_has_thrown_and_throws_it_on) {
  std::atomic<int> begun{0};
  const auto run = [&](std::size_t place, const AnyDevice&) {
    ++begun;
    if (place == 4) throw std::runtime_error("the fifth");
  };
  EXPECT_THROW(side_by_side(1000, cpus(1), run), std::runtime_error);
  EXPECT_EQ(begun, 5);
}

TEST(SideBySide, of_nothing_calls_nothing) {
  side_by_side(0, cpus(2), [](std::size_t, const AnyDevice&) { FAIL(); });
}

TEST(InFlightMembers, take_the_threads_of_the_process) {
  const std::vector<AnyDevice> cpu{make_device(On::cpu)};
  EXPECT_EQ(in_flight(1000, 0, 1e6, cpu).count, thread_limit());
  EXPECT_EQ(in_flight(1, 0, 1e6, cpu).count, 1) << "one member needs one thread";
}

TEST(InFlightMembers, are_as_many_as_asked_for) {
  const std::vector<AnyDevice> cpu{make_device(On::cpu)};
  EXPECT_EQ(in_flight(1000, 7, 1e6, cpu).count, 7);
  EXPECT_EQ(in_flight(5, 7, 1e6, cpu).count, 5) << "there are no more members";
  EXPECT_EQ(in_flight(1000, 7, usable_memory(), cpu).count, 1) << "memory has no room for more";
}

TEST(InFlightMembers, are_no_more_than_memory_has_room_for) {
  const std::vector<AnyDevice> cpu{make_device(On::cpu)};
  const InFlight one = in_flight(1000, 0, usable_memory(), cpu);
  EXPECT_EQ(one.count, 1) << "one runs in any case";
  EXPECT_NE(one.reason.find("memory has room for 1"), std::string::npos) << one.reason;
}

TEST(MemberCost, is_that_of_a_run) {
  const SmallEnsemble ensemble;
  const MemberCost cost = cost_of_member(*drafted(ensemble.domain, ensemble.base), make_device(On::cpu), true);
  EXPECT_GT(cost.bytes, 1e5);
  EXPECT_GT(cost.step_seconds, 0);
  EXPECT_LE(cost.fewest_steps, cost.most_steps);
  EXPECT_EQ(lines_of(cost, 1000, 2).size(), 2u);
  EXPECT_EQ(lines_of({.bytes = 1e6}, 1000, 2).size(), 1u) << "no time where none was measured";
}

}  // namespace
}  // namespace talus::solver::testing
