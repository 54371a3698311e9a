// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers of column-implicit steps. Each precision and shape is compiled in a file of its own, in instances/: together
// they take minutes.
#pragma once

#include <memory>

#include "solver/grid/shape_functions.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// A solver of column-implicit steps in the precision Real with the shape functions Shape, on `device`, from `state`.
/// The scene gives the grid, the bed and the contact points. Throws NumericalError where the device has too little
/// memory.
template <class Real, class Shape>
std::unique_ptr<Solver> make_column_implicit_solver(const Scene& scene, const IntegratorSettings& settings,
                                                    const AnyDevice& device, const SolverState& state);

#define TALUS_ELSEWHERE(Real, Shape)                                                \
  extern template std::unique_ptr<Solver> make_column_implicit_solver<Real, Shape>( \
      const Scene&, const IntegratorSettings&, const AnyDevice&, const SolverState&)
TALUS_ELSEWHERE(float, Linear);
TALUS_ELSEWHERE(float, Quadratic);
TALUS_ELSEWHERE(float, Gimp);
TALUS_ELSEWHERE(double, Linear);
TALUS_ELSEWHERE(double, Quadratic);
TALUS_ELSEWHERE(double, Gimp);
#undef TALUS_ELSEWHERE

}  // namespace talus::solver
