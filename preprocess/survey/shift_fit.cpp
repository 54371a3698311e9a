// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/shift_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"

namespace talus::preprocess {

namespace {

constexpr std::size_t most_rows = 500000;
constexpr double least_spread = 0.02;  // of slope, in any direction, that tells a shift
constexpr int passes = 5;

struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double weights = 0, squares = 0;
};

NormalEquations sum_up(const ShiftRows& rows, const std::vector<int>& sought, const std::vector<double>& rest,
                       double centre, double scale) {
  const auto n = static_cast<Eigen::Index>(sought.size());
  NormalEquations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd row(n);
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const double far = scale > 0 ? (rest[k] - centre) / (biweight_cut * scale) : 0;
    if (std::abs(far) >= 1) continue;
    const double weight = (1 - far * far) * (1 - far * far);
    for (Eigen::Index j = 0; j < n; ++j)
      row[j] = rows.row[k][static_cast<std::size_t>(sought[static_cast<std::size_t>(j)])];
    sum.matrix += weight * row * row.transpose();
    sum.right += weight * row * rows.misfit[k];
    sum.weights += weight;
    sum.squares += weight * (rest[k] - centre) * (rest[k] - centre);
  }
  return sum;
}

}  // namespace

ShiftRows rows_of(const std::vector<Patch>& patches, const Placement& placement, double length) {
  std::size_t stable = 0;
  for (const Patch& p : patches) stable += static_cast<std::size_t>(std::count(p.stable.begin(), p.stable.end(), 1));
  const std::size_t stride = std::max<std::size_t>(1, stable / most_rows);
  ShiftRows rows;
  std::size_t seen = 0;
  for (const Patch& p : patches) {
    const std::vector<double> d = misfit(p, placement);
    const MapGrid& grid = p.before.grid;
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.columns; ++c) {
        const std::size_t i = grid.index(c, r);
        if (!p.stable[i] || std::isnan(d[i]) || seen++ % stride != 0) continue;
        rows.row.push_back({p.slope_x[i], p.slope_y[i], -1, -(grid.x(c) - placement.centre_x) / length,
                            -(grid.y(r) - placement.centre_y) / length});
        rows.misfit.push_back(d[i]);
      }
    }
  }
  return rows;
}

ShiftFit fit_shift(const ShiftRows& rows, const std::vector<int>& sought) {
  const auto n = static_cast<Eigen::Index>(sought.size());
  ShiftFit fit;
  std::vector<double> rest = rows.misfit;
  double scale = nmad(rest), centre = median(rest);
  for (int pass = 0; pass < passes; ++pass) {
    const NormalEquations sum = sum_up(rows, sought, rest, centre, scale);
    const Eigen::LDLT<Eigen::MatrixXd> factor(sum.matrix);
    const Eigen::VectorXd value = factor.solve(sum.right);
    const Eigen::VectorXd variance =
        factor.solve(Eigen::MatrixXd::Identity(n, n)).diagonal() * (sum.squares / sum.weights);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto place = static_cast<std::size_t>(sought[static_cast<std::size_t>(j)]);
      fit.value[place] = value[j];
      fit.error[place] = std::sqrt(std::max(0.0, variance[j]));
    }
    for (std::size_t k = 0; k < rest.size(); ++k) {
      rest[k] = rows.misfit[k];
      for (std::size_t j = 0; j < fit.value.size(); ++j) rest[k] -= rows.row[k][j] * fit.value[j];
    }
    scale = nmad(rest);
    centre = 0;
  }
  return fit;
}

bool tells_a_shift(const ShiftRows& rows) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& row : rows.row) mean += Eigen::Vector2d(row[shift_x], row[shift_y]);
  const double count = static_cast<double>(rows.row.size());
  mean /= count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& row : rows.row) {
    const Eigen::Vector2d from_mean = Eigen::Vector2d(row[shift_x], row[shift_y]) - mean;
    spread += from_mean * from_mean.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread / count);
  return std::sqrt(std::max(0.0, axes.eigenvalues()[0])) > least_spread;
}

}  // namespace talus::preprocess
