// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many members run at a time, and what runs beside what.
#include "solver/ensemble/side_by_side.hpp"

#include <set>
#include <thread>

#include "common/stage/machine.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/member_cost.hpp"
#include "solver/plan/trial.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

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
