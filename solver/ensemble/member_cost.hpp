// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a member of an ensemble takes, by a trial.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solver/parallel/any_device.hpp"
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

}  // namespace talus::solver
