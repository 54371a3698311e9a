// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From a recipe's options to what implicit steps are controlled by.
#pragma once

#include "solver/implicit/controls.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The controls of implicit steps that the options ask for, in SI units.
ImplicitControls make_implicit_controls(const SolveOptions& options);

}  // namespace talus::solver
