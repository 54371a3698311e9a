// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One member of an ensemble: a run whose maps and numbers are taken, and nothing written.
#pragma once

#include <optional>

#include "common/domain/domain.hpp"
#include "common/ensemble/counts.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// The maps and numbers of a member's run.
struct MemberRun {
  RunMaps maps;
  MemberResult result;
};

/// This function runs a member to its end. Its maps have the bits of run.h5 of the same domain and options run by
/// itself, on the CPU and where the options ask for deterministic sums. None: the process was interrupted. It throws
/// NumericalError, and DataError where the scene is refused.
std::optional<MemberRun> run_member(const Domain& domain, const SolveOptions& options, const AnyDevice& device);

/// The numbers of a member by its maps: run-out, areas, largest values. `threshold`: thickness from which a cell counts
/// as covered [m].
MemberResult measured(const RunMaps& maps, double threshold);

}  // namespace talus::solver
