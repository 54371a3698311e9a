// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What runs may ask for, with several at a time: the results are those of one at a time.
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/run_members.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

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
    {"no_flight", "", {{"solve.base.separation", "none"}}},
    {"elastic", "", {{"solve.material.model", "neo-hookean"}}},
    {"grains", "", {{"solve.material.model", "mu-of-i"}}},
    {"mud", "", {{"solve.material.model", "herschel-bulkley"}}},
};

/// Members that all ask for it, with friction of their own.
MemberTable table_of(const Asked& asked) {
  MemberTable table;
  table.design = "table";
  table.count = 4;
  table.columns = {{"solve.base.friction_angle_deg", {8, 10, 12, 14}, {}}};
  for (const auto& [key, name] : asked.values) table.columns.push_back({key, {0, 0, 0, 0}, {name}});
  table.own_domain.assign(4, 0);
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

/// On a GPU sums come in any order, so that equal runs differ by rounding, which grows as the mass slides.
TEST_P(SeveralAtATime, give_what_one_at_a_time_gives) {
  const double tolerance = GetParam() == On::cpu ? 0 : 1e-3;
  for (const Asked& asked : everything_asked) {
    SCOPED_TRACE(asked.name);
    const SmallEnsemble ensemble(table_of(asked), asked.lines, /*deterministic=*/false);
    write_wall(ensemble.scratch / "wall.vdb");
    const Members members = ensemble.members();
    EnsembleCounts one = ensemble.counts(), four = ensemble.counts();
    EXPECT_TRUE(run_members(members, one, {.devices = devices_for(1, GetParam())}));
    EXPECT_TRUE(run_members(members, four, {.devices = devices_for(4, GetParam())}));
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

TALUS_IN_EACH_PLACE(SeveralAtATime);

}  // namespace
}  // namespace talus::solver::testing
