// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve --budget: run.h5, domain.vdb and the domains beside it -> budget.h5.
#pragma once

#include "common/budget/budget.hpp"
#include "common/stage/depends.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/on.hpp"
#include "solver/run/run_stage.hpp"

namespace talus::solver {

/// What the command line says of a budget.
struct BudgetFlags {
  On on = On::cpu;       ///< cpu or gpu; of GPUs all that CUDA sees
  int at_a_time = 0;     ///< runs at a time; 0: as many as suit
  bool plan = false;     ///< say what would run, and run nothing
  bool restart = false;  ///< go on from what is finished, which must be there
  bool resume = false;   ///< go on from it where there is any
};

/// This function refuses (RecipeError) a budget of what is no single run in time.
void refuse_budget(const StageContext& context, const SolveOptions& options, const RunFlags& flags);

/// Whether run.h5 is of this recipe, this domain and this version already, which is said then. Throws DataError.
bool is_this_run(StageContext& context);

/// What the budget reads and writes, added to what the run itself does.
void add_depends_of_budget(const StageContext& context, const BudgetOptions& budget, Dependencies& depends);

/// This function makes the runs of the budget of run.h5 and writes them, or says what they take (`plan`). It adds to
/// the results. It throws Interrupted with what is finished left behind, RecipeError, DataError, and NumericalError
/// where every run fails.
void run_budget(StageContext& context, const BudgetFlags& flags, const BudgetOptions& options);

}  // namespace talus::solver
