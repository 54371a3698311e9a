// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/grid/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/grid/shape_functions.hpp"

namespace talus {
namespace {

/// The weights along one direction of the value and slope at a node itself.
struct NodeWeights {
  double value[3], slope[3];  // at the nodes before, at and after; slope per cell
};

NodeWeights node_weights(bool quadratic) {
  if (quadratic) return {{0.125, 0.75, 0.125}, {-0.5, 0.0, 0.5}};
  return {{0.0, 1.0, 0.0}, {-0.5, 0.0, 0.5}};  // mean of the slopes of the two cells
}

/// This function gives nodes that are not known beside known ones the mean value of those.
template <class Known>
void fill_beside(const GridShape& shape, const Known& known, std::vector<double>& values) {
  for (int j = 0; j < shape.rows; ++j) {
    for (int i = 0; i < shape.columns; ++i) {
      if (known(shape.index(i, j))) continue;
      double sum = 0;
      int count = 0;
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, shape.rows - 1); ++b) {
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, shape.columns - 1); ++a) {
          if (!known(shape.index(a, b))) continue;
          sum += values[shape.index(a, b)];
          ++count;
        }
      }
      if (count > 0) values[shape.index(i, j)] = sum / count;
    }
  }
}

/// Slopes at the nodes, and which are open: where all nodes around have an elevation.
void measure_slopes(const GridShape& shape, TerrainTables& tables) {
  const NodeWeights w = node_weights(shape.quadratic);
  for (int j = 1; j + 1 < shape.rows; ++j) {
    for (int i = 1; i + 1 < shape.columns; ++i) {
      bool inside = true;
      double sx = 0, sy = 0;
      for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
          inside = inside && std::isfinite(shape.terrain[shape.index(i + a, j + b)]);
          const double z = tables.terrain[shape.index(i + a, j + b)];
          sx += w.slope[a + 1] * w.value[b + 1] * z;
          sy += w.value[a + 1] * w.slope[b + 1] * z;
        }
      }
      if (!inside) continue;
      tables.slope_x[shape.index(i, j)] = sx / shape.spacing;
      tables.slope_y[shape.index(i, j)] = sy / shape.spacing;
      tables.open[shape.index(i, j)] = 1;
    }
  }
}

}  // namespace

TerrainTables make_terrain_tables(const GridShape& shape) {
  TerrainTables tables;
  tables.datum = std::numeric_limits<double>::infinity();
  for (double z : shape.terrain)
    if (std::isfinite(z)) tables.datum = std::min(tables.datum, z);
  tables.terrain.assign(shape.terrain.size(), 0.0);
  tables.slope_x = tables.slope_y = tables.terrain;
  tables.open.assign(shape.terrain.size(), 0);
  for (std::size_t n = 0; n < shape.terrain.size(); ++n)
    if (std::isfinite(shape.terrain[n])) tables.terrain[n] = shape.terrain[n] - tables.datum;
  // Only curves beyond the places where points may be look at nodes without ground.
  fill_beside(
      shape, [&](std::size_t n) { return std::isfinite(shape.terrain[n]); }, tables.terrain);
  measure_slopes(shape, tables);
  // A node beside the domain's edge, which stencils reach but where no slope can be measured, leans as its neighbours.
  for (std::vector<double>* slope : {&tables.slope_x, &tables.slope_y})
    fill_beside(
        shape, [&](std::size_t n) { return tables.open[n] != 0; }, *slope);
  return tables;
}

double terrain_at(const GridShape& shape, const TerrainTables& tables, double xi, double eta) {
  const auto sample = [&](auto kind) {
    using Shape = decltype(kind);
    double wx[3], wy[3], unused[3];
    const double ci = std::floor(xi + 0.5), cj = std::floor(eta + 0.5);
    const int i = static_cast<int>(ci) + Shape::first(xi - ci), j = static_cast<int>(cj) + Shape::first(eta - cj);
    Shape::weigh(xi - ci, 0.0, wx, unused);
    Shape::weigh(eta - cj, 0.0, wy, unused);
    double z = 0;
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        const int ii = std::clamp(i + a, 0, shape.columns - 1), jj = std::clamp(j + b, 0, shape.rows - 1);
        z += wx[a] * wy[b] * tables.terrain[shape.index(ii, jj)];
      }
    }
    return z;
  };
  return shape.quadratic ? sample(Quadratic{}) : sample(Linear{});
}

}  // namespace talus
