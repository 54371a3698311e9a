// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve for an ensemble: members.h5 and domain.vdb -> counts.h5.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/domain/domain.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/on.hpp"

namespace talus::solver {

/// What the command line says of an ensemble.
struct EnsembleFlags {
  On on = On::cpu;                          ///< cpu or gpu; of GPUs all that CUDA sees
  std::optional<MemberRange> members = {};  ///< a part; none: all
  bool restart = false;                     ///< go on from what is finished, which must be there
  bool resume = false;                      ///< go on from it where there is any
  int at_a_time = 0;                        ///< members that run at a time; 0: as the program decides
  bool plan = false;                        ///< say what would run, and run nothing
};

/// The members that "A:B" names, from 0, B not included. Throws RecipeError.
MemberRange member_range(const std::string& words);

/// The number of members at a time that --at-a-time asks for. Throws RecipeError.
int members_at_a_time(const std::string& words);

/// What the ensemble reads and writes.
Dependencies depends_of_ensemble(const StageContext& context, const EnsembleFlags& flags);

/// This function runs the members and writes their counts. `domain` is the base domain, `base` the options of the
/// recipe itself. It adds to the results and returns the facts for the used recipe. It throws NumericalError where too
/// many members fail, Interrupted with what is finished left behind, RecipeError and DataError.
Facts run_ensemble(StageContext& context, const EnsembleFlags& flags, const std::shared_ptr<const Domain>& domain,
                   const SolveOptions& base);

}  // namespace talus::solver
