// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many members run at a time, and what a member takes.
#include "solver/ensemble/in_flight.hpp"

#include "common/stage/machine.hpp"
#include "solver/ensemble/member_cost.hpp"
#include "solver/plan/trial.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

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
