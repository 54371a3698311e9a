// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a step that no halving could bring to convergence.
#pragma once

#include "solver/integrator/solver.hpp"

namespace talus::solver {

/// This function throws the NumericalError that names the step, its unbalanced force and the way out.
[[noreturn]] void refuse_step(const Clock& clock, double step, const StepStats& stats, bool dynamic);

}  // namespace talus::solver
