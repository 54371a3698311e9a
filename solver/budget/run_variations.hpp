// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of an error budget, several at a time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/budget/budget.hpp"
#include "solver/budget/variations.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// How the runs of a budget are made.
struct BudgetPlan {
  std::shared_ptr<const Domain> domain;  ///< of the run itself
  BudgetPaths paths;                     ///< of the domains beside it
  std::vector<AnyDevice> devices;        ///< one for each run at a time, with a stream of its own on a GPU
  std::function<void()> save = {};       ///< called as a run has ended, while no other is being noted
};

/// The domain on which a variation runs; it reads a file where that is one of its own. Throws DataError.
std::shared_ptr<const Domain> domain_of(const Variation& variation, const std::shared_ptr<const Domain>& base,
                                        const BudgetPaths& paths);

/// This function makes the runs of `budget` that wait, each as `variations` says at the same place, and notes what came
/// of them. A run that ends by NumericalError or DataError of its scene is noted as failed, with its words. It returns
/// whether all have been made: not so where the process was interrupted.
bool run_variations(const std::vector<Variation>& variations, Budget& budget, const BudgetPlan& plan);

}  // namespace talus::solver
