// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver of explicit steps in single precision with hats averaged over the box of each particle.
#include "solver/explicit/explicit_solver.hpp"

template struct talus::solver::ExplicitSolvers<float, talus::Gimp>;
