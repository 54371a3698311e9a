// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How exactly the linear system of a Newton iteration is solved.
#pragma once

#include <algorithm>

#include "solver/implicit/controls.hpp"

namespace talus::solver {

/// The tolerance of the next linear system: as Newton's last iteration got on (Eisenstat & Walker 1996, choice 2, with
/// their safeguard), and no finer than Newton's own tolerance asks for.
struct LinearForcing {
  double last_residual = 0, last = 0.1;

  /// The relative residual [-] to solve the next system to, where the unbalanced force over its size is `residual`.
  double next(double residual, const ImplicitControls& controls) {
    constexpr double gamma = 0.9, most = 0.1, first = 1e-3;  // a nearly linear step should be done in two
    if (controls.forcing == Forcing::fixed) return controls.linear_tolerance;
    double tolerance = first;
    if (last_residual > 0) {
      tolerance = gamma * (residual / last_residual) * (residual / last_residual);
      if (gamma * last * last > 0.1) tolerance = std::max(tolerance, gamma * last * last);
    }
    last_residual = residual;
    last = std::clamp(tolerance, 1e-12, most);
    return std::max(controls.linear_tolerance, std::min(most, std::max(last, 0.1 * controls.tolerance / residual)));
  }
};

}  // namespace talus::solver
