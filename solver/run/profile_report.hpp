// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The report of --profile at the end of a run: phases, kernels with the bytes they move, memory by owner.
#pragma once

#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "solver/parallel/profile.hpp"

namespace talus::solver {

/// The profile in lines of text. `copy` is the bandwidth of a copy where the run was [B/s].
std::vector<std::string> profile_lines(const RunSummary& summary, const Profile& profile, double copy);

/// A row for every kernel: kernel, phase, calls, seconds, bytes it has to move (each read or written once; empty where
/// that is not known), share of the copy's bandwidth.
std::string profile_csv(const Profile& profile, double copy);

}  // namespace talus::solver
