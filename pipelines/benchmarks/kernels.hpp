// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What steps and kernels cost, measured without files: a block of sand that slides along, from 1e4 points on.
#pragma once

#include <string>
#include <vector>

#include "solver/options/solve.hpp"
#include "solver/parallel/on.hpp"

namespace talus::benchmarks {

/// One way of stepping, at one size.
struct KernelRun {
  std::string method;  // "explicit", "newmark"
  std::string shape, precision, place;
  double points = 0;
  int steps = 0;            // timed, in each of three rounds
  double step_seconds = 0;  // median of the rounds
  double bytes = 0;         // of points, grid and solver
  // newmark: a step, in those whose phases are told
  double newton_iterations = 0, cg_iterations = 0;
  double check = 0;  // how far the momentum is off the closed form, over that at 0.36 m/s
  bool pass = false;
  std::vector<std::pair<std::string, double>> phases;  // seconds a step, in a round of its own
  struct Kernel {
    std::string name;
    double seconds = 0, bytes = 0;  // a step
  };
  std::vector<Kernel> kernels;                         // of that round, the longest first
  std::vector<std::pair<std::string, double>> memory;  // bytes by owner

  double eta() const { return step_seconds / points; }
  double seconds_of(const std::string& phase) const;  ///< of the phase of this name, a step; 0 without one
  /// Of a Newton iteration: stress and tangent, contacts, preconditioner and conjugate gradients; 0 without any.
  double newton_seconds() const;
};

struct KernelSetting {
  bool newmark = false;
  ShapeKind shape = ShapeKind::quadratic;
  solver::Precision precision = solver::Precision::double_;
  double points = 1e4;
};

/// "explicit quadratic single", say.
std::string name_of(const KernelSetting& setting);

/// Builds the block, steps, checks, times. Throws what the solver throws.
KernelRun time_kernels(const KernelSetting& setting, On on);

}  // namespace talus::benchmarks
