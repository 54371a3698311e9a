// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver of implicit steps in single precision with hats.
#include "solver/implicit/implicit_solver.hpp"

template struct talus::solver::ImplicitSolvers<float, talus::Linear>;
