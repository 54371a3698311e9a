// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/energy_line.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// The least friction the flow can meet: on its bed, or inside where the bed holds it.
double least_friction(const SolveOptions& o) {
  const auto base = make_base_friction<double>(o);
  if (base.holds()) return o.material.internal_friction();
  // Friction falls or grows with speed, if it changes at all, and is least under the thickest flow.
  const auto at_speed = [&](double speed) {
    return base.coefficient(base.uniform, {.speed = speed, .normal_stress = 1e41, .duration = 0, .load = 1e40});
  };
  return std::min(at_speed(0), at_speed(1e30));
}

/// The mean of something over cells.
struct Mean {
  double sum = 0;
  long long count = 0;
  void add(double value) {
    if (!std::isfinite(value)) return;
    sum += value;
    ++count;
  }
};

/// Calls f(column, row) for every inner cell that lies below the energy line.
template <class F>
void each_cell_below(const EnergyLine& line, const Raster& terrain, F&& f) {
  for (int row = 1; row + 1 < terrain.grid.rows; ++row) {
    for (int column = 1; column + 1 < terrain.grid.columns; ++column)
      if (line.head(terrain, column, row) > 0) f(column, row);
  }
}

}  // namespace

double EnergyLine::head(const Raster& terrain, int column, int row) const {
  const MapGrid& grid = terrain.grid;
  return z - terrain.at(column, row) - friction * std::hypot(grid.x(column) - x, grid.y(row) - y);
}

double EnergyLine::largest_head(const Raster& terrain) const {
  double largest = 0;
  for (int row = 0; row < terrain.grid.rows; ++row)
    for (int column = 0; column < terrain.grid.columns; ++column)
      largest = std::max(largest, head(terrain, column, row));  // NaN leaves it as it is
  return largest;
}

EnergyLine energy_line_of(const Domain& domain, const SolveOptions& options, const Inflow& inflow) {
  EnergyLine line{.friction = least_friction(options)};
  each_cell(domain.grid, [&](int column, int row) {
    const double thickness = domain.release_thickness.at(column, row), ground = domain.terrain.at(column, row);
    if (!(thickness > 0) || !(ground + thickness > line.z)) return;
    line.x = domain.grid.x(column);
    line.y = domain.grid.y(row);
    line.z = ground + thickness;
  });
  const double g = options.gravity_size();
  for (const InflowTop& top : inflow.tops) {
    const double head = g > 0 ? top.z + top.speed * top.speed / (2 * g) : top.z;
    if (head > line.z) line = {.x = top.x, .y = top.y, .z = head, .friction = line.friction};
  }
  return line;
}

SpeedBound speed_bound(const Domain& domain, const SolveOptions& o, const Scene& scene) {
  SpeedBound bound{.line = energy_line_of(domain, o, scene.inflow)};
  const double g = o.gravity_size();
  const double start = o.initial_speed();
  bound.fall = std::sqrt(2 * g * bound.line.largest_head(domain.terrain));
  bound.speed = bound.fall + start + scene.shaking.velocity_range();
  for (const double height : domain.points.height) bound.depth = std::max(bound.depth, height);
  return bound;
}

double bend_over_thickness(const Domain& domain, const EnergyLine& line) {
  const Raster& z = domain.terrain;
  Mean bend;
  each_cell_below(line, z, [&](int column, int row) {
    bend.add(std::abs(z.at(column - 1, row) - 2 * z.at(column, row) + z.at(column + 1, row)));
    bend.add(std::abs(z.at(column, row - 1) - 2 * z.at(column, row) + z.at(column, row + 1)));
  });
  const double thickness = median_thickness(domain.release_thickness);
  return bend.count > 0 && thickness > 0 ? bend.sum / static_cast<double>(bend.count) / 8 / thickness : 0;
}

double steepness(const Domain& domain, const EnergyLine& line) {
  const Raster& z = domain.terrain;
  const double over = 1 / (2 * z.grid.cell);
  Mean steep;
  each_cell_below(line, z, [&](int column, int row) {
    const double x = (z.at(column + 1, row) - z.at(column - 1, row)) * over,
                 y = (z.at(column, row + 1) - z.at(column, row - 1)) * over;
    steep.add(1 + x * x + y * y);
  });
  return steep.count > 0 ? steep.sum / static_cast<double>(steep.count) : 1;
}

}  // namespace talus::solver
