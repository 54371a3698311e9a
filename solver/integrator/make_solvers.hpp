// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers by the kind of their steps, in the precision Real with the shape functions Shape. Each is compiled in a file
// of its own, in the folder instances/ beside its steps: together they take minutes.
#pragma once

#include <memory>

#include "solver/integrator/settings.hpp"
#include "solver/integrator/solver.hpp"

namespace talus::solver {

struct ImplicitControls;

template <class Real, class Shape>
struct ExplicitSolvers {
  /// A solver on `device`, from `state`. The scene gives the grid, the bed and the contact points. Throws
  /// NumericalError where the device has too little memory.
  static std::unique_ptr<Solver> make(const Scene& scene, const IntegratorSettings& settings, const AnyDevice& device,
                                      const SolverState& state);
};

template <class Real, class Shape>
struct ColumnImplicitSolvers {
  /// A solver as ExplicitSolvers::make() gives it.
  static std::unique_ptr<Solver> make(const Scene& scene, const IntegratorSettings& settings, const AnyDevice& device,
                                      const SolverState& state);
};

template <class Real, class Shape>
struct ImplicitSolvers {
  /// A solver as ExplicitSolvers::make() gives it.
  static std::unique_ptr<Solver> make(const Scene& scene, const IntegratorSettings& settings,
                                      const ImplicitControls& controls, const AnyDevice& device,
                                      const SolverState& state);
};

#define TALUS_ELSEWHERE(Real, Shape)                         \
  extern template struct ExplicitSolvers<Real, Shape>;       \
  extern template struct ColumnImplicitSolvers<Real, Shape>; \
  extern template struct ImplicitSolvers<Real, Shape>
TALUS_ELSEWHERE(float, Linear);
TALUS_ELSEWHERE(float, Quadratic);
TALUS_ELSEWHERE(float, Gimp);
TALUS_ELSEWHERE(double, Linear);
TALUS_ELSEWHERE(double, Quadratic);
TALUS_ELSEWHERE(double, Gimp);
#undef TALUS_ELSEWHERE

}  // namespace talus::solver
