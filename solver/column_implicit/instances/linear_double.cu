// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver of column-implicit steps in double precision with hats.
#include "solver/column_implicit/column_implicit_solver.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_column_implicit_solver<double, Linear>(const Scene&, const IntegratorSettings&,
                                                                             const AnyDevice&, const SolverState&);

}  // namespace talus::solver
