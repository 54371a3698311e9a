// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laplace's operator within an outline, zero on it: what the sliding surface's equations are made of.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/release/outline.hpp"

namespace talus::preprocess {

/// A u = -h^2 laplace(u) over the cells of an outline, u = 0 where the outline crosses rows and columns of centres
/// (symmetric, second order: Gibou et al. 2002). Chosen cells can be held at zero as well.
class RimProblem {
 public:
  using Vector = Eigen::VectorXd;

  explicit RimProblem(const Outline& outline);

  /// Factorise with these cells held at zero [cells of the outline]. Throws NumericalError.
  void hold(const std::vector<char>& held);
  /// u for A u = load; 0 at held cells.
  Vector solve(Vector load) const;
  /// A u, held cells or not.
  Vector apply(const Vector& u) const { return operator_ * u; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix operator_;
  std::vector<char> held_;
  Eigen::SimplicialLDLT<Matrix> factors_;
};

/// h^2 laplace of the ground at the cells of the outline [m]; ground without elevation (beyond the grid) counts as
/// level.
RimProblem::Vector ground_curvature(const Raster& before, const Outline& outline);

}  // namespace talus::preprocess
