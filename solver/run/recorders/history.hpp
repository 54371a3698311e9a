// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// History: the numbers of a run over time, written as /history of run.h5.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/recorders/recorder.hpp"

namespace talus::solver {

/// What a history is for: to be kept with the run, or to judge by whether the run can be trusted.
enum class HistoryUse { kept, judged };

/// The history of a run: its columns and the recorders that fill them.
class History {
 public:
  /// The constructor makes the recorders that the recipe asks for, which may keep references to the scene; of a history
  /// to judge by those alone that tell something of that. It throws RecipeError where one of them cannot measure what
  /// it is asked to.
  History(const SolveOptions& options, const Scene& scene, HistoryUse use = HistoryUse::kept);

  /// The method adds a row.
  void record(const Instant& now);
  /// The method writes the rows so far down for a checkpoint, and what recorders know besides.
  void keep(RunMemory& memory) const;
  /// The method goes on from the memory of a checkpoint. It throws DataError when its columns are others.
  void restore(const RunMemory& memory);

  /// All rows so far, column by column.
  const RunHistory& rows() const { return rows_; }
  /// The last value of a column, 0 before the first record.
  double last(const std::string& name) const;
  /// The method logs results and adds findings at the end of the run.
  void conclude() const;

 private:
  std::vector<std::unique_ptr<Recorder>> recorders_;
  RunHistory rows_;
};

}  // namespace talus::solver
