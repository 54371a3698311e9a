// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/scale_release.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace talus {
namespace {

/// The cell of the map under a point; points beyond the grid belong to its edge.
std::size_t cell_under(const MapGrid& grid, double x, double y) {
  const auto place = [](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset)), 0, count - 1);
  };
  return grid.index(place((x - grid.west) / grid.cell, grid.columns), place((y - grid.south) / grid.cell, grid.rows));
}

/// Thickness of the erodible layers in each cell [m], by the volumes of their points.
std::vector<double> erodible_thickness(const Domain& domain) {
  std::vector<double> thickness(domain.grid.count(), 0.0);
  const SeedPoints& points = domain.points;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.release[p] < domain.erodible)
      thickness[cell_under(domain.grid, points.x[p], points.y[p])] += points.volume[p];
  for (double& value : thickness) value /= domain.grid.cell * domain.grid.cell;
  return thickness;
}

}  // namespace

void scale_release(Domain& domain, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) throw std::logic_error("scale_release: a factor that is not positive");
  for (std::size_t i = 0; i < domain.release_thickness.values.size(); ++i) {
    double& thickness = domain.release_thickness.values[i];
    if (!(thickness > 0)) continue;  // NaN is not
    domain.before.values[i] += (factor - 1) * thickness;
    thickness *= factor;
  }
  SeedPoints& points = domain.points;
  std::vector<double> ground;
  if (domain.erodible > 0) ground = erodible_thickness(domain);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.release[p] < domain.erodible) continue;
    points.volume[p] *= factor;
    const double foot = ground.empty() ? 0.0 : ground[cell_under(domain.grid, points.x[p], points.y[p])];
    points.height[p] = foot + factor * (points.height[p] - foot);
  }
  domain.active.reset();  // points may stand in other layers now
}

}  // namespace talus
