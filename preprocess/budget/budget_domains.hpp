// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The domains that an error budget needs beside the run's own: with other cells, and with other errors of the survey.
#pragma once

#include "common/budget/budget.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/ensemble/ensemble.hpp"

namespace talus::preprocess {

/// Writes them into OUT/budget, and which of them could be made into OUT/budget/domains.txt. `domain` is that of the
/// run; a domain that cannot be made is left out with its reason, which is logged. Domains that are there and say that
/// they were made of the same are left as they are. It adds to the results. Throws DataError (disk full) and
/// Interrupted.
void write_budget_domains(StageContext& context, const BudgetOptions& options, const EnsembleBase& base,
                          const Domain& domain);

/// Removes what an earlier budget left.
void remove_budget_domains(const BudgetPaths& paths);

}  // namespace talus::preprocess
