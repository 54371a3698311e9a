// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/in_flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/stage/machine.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

constexpr double share_of_memory = 0.8;  ///< what is left is for maps on the host and for other processes

/// The members that the memory of one device has room for.
double room(const AnyDevice& device, double bytes_each) {
  const double free = device.is_gpu() ? free_memory(device.gpu()) : free_memory(device.cpu());
  return std::floor(share_of_memory * std::min(free, device.is_gpu() ? free : usable_memory()) / bytes_each);
}

}  // namespace

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
