// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver of column-implicit steps in single precision with quadratic B-splines.
#include "solver/column_implicit/column_implicit_solver.hpp"

template struct talus::solver::ColumnImplicitSolvers<float, talus::Quadratic>;
