// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/in_flight.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "common/stage/context.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/pace.hpp"
#include "solver/plan/describe_plan.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

constexpr double trial_seconds = 0.5;

constexpr double share_of_memory = 0.8;  ///< what is left is for maps on the host and for other processes

/// The members that the memory of one device has room for.
double room(const AnyDevice& device, double bytes_each) {
  const double free = device.is_gpu() ? free_memory(device.gpu()) : free_memory(device.cpu());
  return std::floor(share_of_memory * std::min(free, device.is_gpu() ? free : usable_memory()) / bytes_each);
}

}  // namespace

MemberCost cost_of_member(const Plan& base, const AnyDevice& device, bool timed) {
  const Findings found("solve", {}, Findings::Log::kept_back);
  const Alone alone;
  const Trial trial = try_steps(base, device, timed ? trial_seconds : 0);
  const StepCount count = count_steps(base, trial.step);
  return {.bytes = static_cast<double>(trial.bytes),
          .step_seconds = trial.seconds,
          .fewest_steps = count.fewest,
          .most_steps = count.most};
}

std::vector<std::string> lines_of(const MemberCost& cost, std::int64_t count, int in_flight) {
  std::vector<std::string> lines{fmt::format("{:<12} {:.1f} MB for each member now", "memory", cost.bytes / 1e6)};
  if (!(cost.step_seconds > 0)) return lines;
  const double rounds = static_cast<double>(count) / in_flight;
  lines.push_back(
      fmt::format("{:<12} {} to {} at {:.3g} ms a step of a member by itself; members that run at a time "
                  "share caches, memory and a GPU",
                  "time", time_words(rounds * cost.fewest_steps * cost.step_seconds),
                  time_words(rounds * cost.most_steps * cost.step_seconds), 1e3 * cost.step_seconds));
  return lines;
}

void side_by_side(std::size_t count, const std::vector<AnyDevice>& devices,
                  const std::function<void(std::size_t place, const AnyDevice& device)>& run) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&, &here = context()](const AnyDevice& device) {
    const BindContext bind(here);
    const Alone alone;
    try {
      for (;;) {
        if (interrupted() || failed) return;
        const std::size_t place = next++;
        if (place >= count) return;
        run(place, device);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> one(mutex);
      failed = true;
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (const AnyDevice& device : devices) threads.emplace_back(work, std::cref(device));
  }
  if (failure) std::rethrow_exception(failure);
}

InFlight in_flight(std::int64_t members, int asked, double bytes_each, const std::vector<AnyDevice>& devices) {
  const bool on_gpus = devices.front().is_gpu();
  const auto places = static_cast<double>(devices.size());
  const double wanted = asked > 0 ? std::ceil(asked / places) : on_gpus ? most_on_a_gpu : thread_limit();
  double least_room = std::numeric_limits<double>::infinity();
  for (const AnyDevice& device : devices) least_room = std::min(least_room, room(device, std::max(bytes_each, 1.0)));
  const double each = std::clamp(least_room, 1.0, wanted);
  const double most = static_cast<double>(asked > 0 ? std::min<std::int64_t>(asked, members) : members);
  const double in_all = std::min(each * places, most);
  InFlight flight;
  flight.count = std::max(1, static_cast<int>(in_all));
  const std::string where = asked > 0 ? "as asked for"
                            : on_gpus ? devices.size() > 1 ? fmt::format("{} GPUs", devices.size()) : "one GPU"
                                      : fmt::format("{} threads", thread_limit());
  flight.reason = least_room < wanted
                      ? fmt::format("memory has room for {:.0f} of {:.1f} MB each", each, bytes_each / 1e6)
                      : fmt::format("{}, {:.1f} MB each", where, bytes_each / 1e6);
  return flight;
}

std::vector<AnyDevice> devices_for(int count, On on) {
  std::vector<AnyDevice> devices;
  const int gpus = on == On::gpu ? GpuDevice::count() : 1;
  for (int k = 0; k < count; ++k) devices.push_back(make_device(on, k % gpus));
  return devices;
}

std::vector<AnyDevice> one_of_each(On on) { return devices_for(on == On::gpu ? GpuDevice::count() : 1, on); }

}  // namespace talus::solver
