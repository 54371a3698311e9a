// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of the members of an ensemble: one, several at a time into counts, and those that are kept whole.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/members.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

struct MemberRun {
  RunMaps maps;
  MemberResult result;
};

/// Does body() for one of many runs; returns in words what it failed by (computation, files, scene). Empty: by nothing.
template <class Body>
std::string failure_of(const Body& body) {
  try {
    body();
  } catch (const NumericalError& error) {
    return error.what();
  } catch (const DataError& error) {
    return error.what();
  } catch (const RecipeError& error) {  // the recipe does not suit this run's scene
    return error.what();
  }
  return {};
}

/// This function runs a member to its end, and adds what it found to the thread's findings. Its maps have the bits of
/// run.h5 of the same plan run by itself, on the CPU and where the options ask for deterministic sums. None: the
/// process was interrupted. It throws NumericalError, and DataError and RecipeError where the scene is refused.
std::optional<MemberRun> run_member(const std::shared_ptr<const Plan>& plan, const AnyDevice& device);

/// The numbers of a member by its maps: run-out, areas, largest values. `threshold`: thickness of covered cells [m].
MemberResult measured(const RunMaps& maps, double threshold);

struct MembersPlan {
  std::vector<AnyDevice> devices;   ///< one for each member in flight, with a stream of its own on a GPU
  std::function<void()> save = {};  ///< called now and then while no member is being counted
  bool edge_fails = false;          ///< a member that comes to the edge of its grid counts as failed
};

/// This function runs the members of `counts` that wait, and counts them as they end, with what they warned of. A
/// member that fails (failure_of) is counted as failed, with its words. It returns whether all have been run: not so
/// where the process was interrupted.
bool run_members(const Members& members, EnsembleCounts& counts, const MembersPlan& plan);

/// Runs the members of `counts` that wait and that the recipe keeps, one after another, each into a folder of its own
/// with run.h5 as a run alone leaves it. They are counted later with the others. It adds to the results.
void keep_runs(StageContext& context, const Members& members, const EnsembleOptions& options,
               const EnsemblePaths& paths, const AnyDevice& device, const EnsembleCounts& counts);

}  // namespace talus::solver
