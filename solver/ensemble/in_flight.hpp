// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many members of an ensemble run at a time, and what each takes, by a trial.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "solver/parallel/device.hpp"
#include "solver/parallel/on.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// Memory and time of one member, by a trial of its first steps.
struct MemberCost {
  double bytes = 0;         ///< where its steps are taken
  double step_seconds = 0;  ///< of a step, alone on its device or thread; 0: not timed
  double fewest_steps = 0;  ///< as long as nothing moves faster than at rest
  double most_steps = 0;    ///< at the speed that the energy line allows
};

/// This function tries the base of an ensemble, which its members are like; `timed`: half a second of its steps.
MemberCost cost_of_member(const Plan& base, const AnyDevice& device, bool timed);

/// The lines of --plan: memory and time of `count` members, `in_flight` at a time.
std::vector<std::string> lines_of(const MemberCost& cost, std::int64_t count, int in_flight);

/// This function calls run(place, device) for each place from 0 to count - 1, in that order, on a thread for each
/// device, whose loops stay on that thread. No more are begun once the process is interrupted or a call has thrown;
/// what the first threw it throws when all threads have ended.
void side_by_side(std::size_t count, const std::vector<AnyDevice>& devices,
                  const std::function<void(std::size_t place, const AnyDevice& device)>& run);

/// The members that run at a time, and why they are so many.
struct InFlight {
  int count = 1;       ///< in all
  std::string reason;  ///< in words
};

/// The most members that a GPU runs at a time: more gain nothing (docs/notes/ensembles.md).
inline constexpr int most_on_a_gpu = 16;

/// Of `members` that need so many bytes each: on the CPU one for every thread of this process, on GPUs most_on_a_gpu
/// for each GPU, or as many as are `asked` for where that is not 0; never more than memory has room for. `devices` are
/// those that members run on: the CPU, or GPUs.
InFlight in_flight(std::int64_t members, int asked, double bytes_each, const std::vector<AnyDevice>& devices);

/// A device for each of so many members at a time, spread over the GPUs that CUDA sees. `on` is cpu or gpu.
std::vector<AnyDevice> devices_for(int count, On on);
/// The CPU, or each GPU once: what in_flight() takes.
std::vector<AnyDevice> one_of_each(On on);

}  // namespace talus::solver
