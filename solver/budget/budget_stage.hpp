// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve --budget: run.h5, domain.vdb and the domains beside it -> budget.h5.
#pragma once

#include <filesystem>

#include "common/budget/budget.hpp"
#include "common/domain/domain.hpp"
#include "common/stage/depends.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/budget/variations.hpp"
#include "solver/parallel/on.hpp"

namespace talus::solver {

/// What the command line says of a budget.
struct BudgetFlags {
  On on = On::cpu;       ///< cpu or gpu; of GPUs all that CUDA sees
  bool restart = false;  ///< go on from what is finished, which must be there
  bool resume = false;   ///< go on from it where there is any
};

/// Whether run.h5 is of this recipe, this domain and this version, so that the budget may be of it.
bool is_run_of(const StageContext& context, const Domain& domain, const std::filesystem::path& file);

/// What the budget reads and writes, added to what the run itself does.
void add_depends_of_budget(const StageContext& context, const BudgetOptions& budget, Dependencies& depends);

/// The lines of --plan: the runs, what each takes, what is left out and why.
std::vector<std::string> plan_of_budget(const StageContext& context, On on, const Domain& domain,
                                        const BudgetBase& base, const BudgetOptions& options);

/// This function makes the runs of the budget of run.h5 and writes them. It adds to the results. `facts` are what is
/// insisted on. It throws Interrupted with what is finished left behind, DataError, and NumericalError where every run
/// fails.
void run_budget(StageContext& context, const BudgetFlags& flags, const Domain& domain, const BudgetBase& base,
                const BudgetOptions& options, const Facts& facts);

}  // namespace talus::solver
