// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a linear solve ended with, iterative or direct.
#pragma once

namespace talus {

/// The iterations, relative residual and outcome of a linear solve.
struct LinearReport {
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b| [-]
  bool converged = false;
  bool indefinite = false;  ///< met a direction of negative curvature: the tangent is no minimum's
};

}  // namespace talus
