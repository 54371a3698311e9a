// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many members of an ensemble run at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/parallel/any_device.hpp"
#include "solver/parallel/on.hpp"

namespace talus::solver {

/// The members that run at a time, and why they are so many.
struct InFlight {
  int count = 1;       ///< in all
  std::string reason;  ///< in words
};

/// The most members that a GPU runs at a time: more gain nothing (docs/notes/ensembles.md).
inline constexpr int most_on_a_gpu = 48;

/// Of `members` that need so many bytes each: on the CPU one for every thread of this process, on GPUs most_on_a_gpu
/// for each GPU, or as many as are `asked` for where that is not 0; never more than memory has room for. `devices` are
/// those that members run on: the CPU, or GPUs.
InFlight in_flight(std::int64_t members, int asked, double bytes_each, const std::vector<AnyDevice>& devices);

/// A device for each of so many members at a time, spread over the GPUs that CUDA sees. `on` is cpu or gpu.
std::vector<AnyDevice> devices_for(int count, On on);
/// The CPU, or each GPU once: what in_flight() takes.
std::vector<AnyDevice> one_of_each(On on);

}  // namespace talus::solver
