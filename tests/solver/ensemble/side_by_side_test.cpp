// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/side_by_side.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "solver/scene/make_solver.hpp"

namespace talus::solver {
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

}  // namespace
}  // namespace talus::solver
