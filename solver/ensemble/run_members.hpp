// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of an ensemble, several at a time, into counts.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "solver/ensemble/members.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// How members are run.
struct MembersPlan {
  std::vector<AnyDevice> devices;   ///< one for each member in flight, with a stream of its own on a GPU
  std::function<void()> save = {};  ///< called now and then while no member is being counted
  bool edge_fails = false;          ///< a member that comes to the edge of its grid counts as failed
};

/// This function runs the members of `counts` that wait, and counts them as they end, with what they warned of. A
/// member that fails (failure_of) is counted as failed, with its words. It returns whether all have been run: not so
/// where the process was interrupted.
bool run_members(const Members& members, EnsembleCounts& counts, const MembersPlan& plan);

}  // namespace talus::solver
