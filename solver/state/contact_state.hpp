// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the contact points of a run remember from step to step.
#pragma once

#include <vector>

namespace talus::solver {

/// The history of the contact points, three numbers for each; empty at the start of a run.
struct ContactState {
  std::vector<double> force;    ///< on the mass, last step [N]
  std::vector<double> impulse;  ///< on the mass so far [N s]
};

}  // namespace talus::solver
