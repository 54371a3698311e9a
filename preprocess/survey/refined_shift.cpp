// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/refined_shift.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "common/gis/crs.hpp"
#include "preprocess/survey/wave_fit.hpp"

namespace talus::preprocess {

namespace {

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
