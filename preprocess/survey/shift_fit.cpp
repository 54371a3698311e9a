// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/shift_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Dense>

#include "common/gis/crs.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/survey/wave_fit.hpp"

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

constexpr int most_steps = 8;
constexpr double stands_still = 1e-3;  // cells
constexpr double anew = 0.1;           // cells, after which what both surveys share is measured anew
constexpr double far_off = 1;          // cells

/// Sine of the part of a cell by which the posts of both surveys lie apart. 0 where it differs over the map, or where
/// the later one has no posts of that size: nothing then pulls towards whole cells.
Eigen::Vector2d phase_of(const Patch& patch, const Placement& placement) {
  const MapGrid &before = patch.before.grid, &after = patch.after.raster.grid;
  if (patch.after.scattered || patch.after.reprojected || !same_crs(before.crs_wkt, after.crs_wkt)) return {0, 0};
  if (std::abs(after.cell / before.cell - 1) * std::max(before.columns, before.rows) > 0.25) return {0, 0};
  const auto sine = [&](double apart) { return std::sin(2 * std::numbers::pi * apart / before.cell); };
  return {sine(after.west + placement.x - before.west), sine(after.south + placement.y - before.south)};
}

/// The fit at the placement where it stands still. Moves the placement; not known where it does not stand still.
struct Stood {
  BandFit fit;
  Eigen::Vector2d spread = Eigen::Vector2d::Zero();
  bool still = false;
};

Stood stand_still(const std::vector<Patch>& patches, Placement& placement) {
  const double cell = patches.front().before.grid.cell;
  std::unique_ptr<WaveFit> waves;
  Eigen::Vector2d since = Eigen::Vector2d::Zero();
  Stood stood;
  for (int step = 0; step < most_steps; ++step) {
    const bool moved = since.norm() > anew;
    if (!waves || moved || !waves->measure(placement)) {
      waves = std::make_unique<WaveFit>(patches, placement);
      since.setZero();
      if (!waves->enough() || !waves->measure(placement)) return stood;
    }
    stood.fit = waves->fit(phase_of(patches.front(), placement));
    if (!stood.fit.known) return stood;
    const Eigen::Vector2d by = stood.fit.shift.cwiseMax(-far_off).cwiseMin(far_off);
    stood.still = by.norm() < stands_still;
    if (stood.still) {
      stood.spread = waves->spread(stood.fit);
      return stood;
    }
    placement.x += by[0] * cell;
    placement.y += by[1] * cell;
    since += by;
  }
  return stood;
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
    each_cell(grid, [&](int c, int r) {
      const std::size_t i = grid.index(c, r);
      if (!p.stable[i] || std::isnan(d[i]) || seen++ % stride != 0) return;
      rows.row.push_back({p.slope_x[i], p.slope_y[i], -1, -(grid.x(c) - placement.centre_x) / length,
                          -(grid.y(r) - placement.centre_y) / length});
      rows.misfit.push_back(d[i]);
    });
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

RefinedShift refined_shift(const std::vector<Patch>& patches, const Placement& placement) {
  const double cell = patches.front().before.grid.cell;
  Placement moved = placement;
  const Stood stood = stand_still(patches, moved);
  const double far = std::hypot(moved.x - placement.x, moved.y - placement.y);
  RefinedShift shift;
  shift.known = stood.still && far <= far_off * cell;
  for (int axis = 0; axis < 2; ++axis) {
    const double noise = std::max(stood.fit.covariance(axis, axis), stood.spread[axis]);
    shift.error[static_cast<std::size_t>(axis)] = cell * std::sqrt(noise + std::pow(stood.fit.folded[axis], 2));
    if (!shift.known)
      shift.error[static_cast<std::size_t>(axis)] =
          std::max({far, far_off * cell, shift.error[static_cast<std::size_t>(axis)]});
  }
  if (shift.known) shift.x = moved.x - placement.x, shift.y = moved.y - placement.y;
  return shift;
}

}  // namespace talus::preprocess
