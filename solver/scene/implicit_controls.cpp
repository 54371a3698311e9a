// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/implicit_controls.hpp"

#include "common/stage/stage.hpp"

namespace talus::solver {

ImplicitControls make_implicit_controls(const SolveOptions& options) {
  const ImplicitOptions& o = options.implicit;
  const NewtonScheme scheme = scheme_of(options);
  return {.dynamic = abilities_of(options.integrator).carry_inertia,
          .step = o.step,
          .step_cuts = o.step_cuts,
          .alpha = scheme.alpha,
          .beta = scheme.beta,
          .newton = {.iterations = o.newton_iterations,
                     .tolerance = scheme.tolerance,
                     .forcing = o.forcing,
                     .linear_tolerance = o.linear_tolerance,
                     .give_up = interrupted},
          .linear = {.solver = o.linear_solver, .iterations = o.linear_iterations},
          .b_bar = o.b_bar};
}

}  // namespace talus::solver
