// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One member of an ensemble: a run whose maps and numbers are taken, and nothing written.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/ensemble/counts.hpp"
#include "common/error.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// The maps and numbers of a member's run.
struct MemberRun {
  RunMaps maps;
  MemberResult result;
};

/// This function does body() for one of many runs and returns what that run failed by, in words: the computation, its
/// files or its scene. Empty: it did not fail.
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

/// The numbers of a member by its maps: run-out, areas, largest values. `threshold`: thickness from which a cell counts
/// as covered [m].
MemberResult measured(const RunMaps& maps, double threshold);

}  // namespace talus::solver
