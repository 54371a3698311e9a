// A point's weights on the nodes around it, and the slope of the terrain under it from the same weights.
#pragma once

#include "solver/grid/background_grid.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/particles/particles.hpp"

namespace talus {

template <class Real, class Shape>
struct Stencil {
  static constexpr int width = Shape::width;
  int i, j, k;                                     // first node; k may be -1, with no weight
  Real wx[width], wy[width], wz[width];            // weights
  Real gx[width], gy[width], gz[width];            // their slopes, per cell
  Real near_x, near_y, near_z;                     // first node minus point, in cells
  bool edge_x = false, edge_y = false, edge_z = false;  // hats beside the ground or a wall
  Real slope_x = 0, slope_y = 0;                   // of the terrain at the point

  TALUS_HD Stencil(const GridView<Real>& grid, const ParticleView<Real>& points, int p) {
    const Real fx = points.offset_x[p], fy = points.offset_y[p], fz = points.offset_z[p];
    const int ax = Shape::weigh(fx, wx, gx), ay = Shape::weigh(fy, wy, gy), az = Shape::weigh(fz, wz, gz);
    i = points.cell_x[p] + ax;
    j = points.cell_y[p] + ay;
    k = points.cell_z[p] + az;
    if (grid.mapping == Mapping::terrain_following) measure_slope(grid);
    near_x = Real(ax) - beside(points.cell_x[p], grid.walls.west, grid.walls.east, fx, grid.lowest_weighed, wx, gx, edge_x);
    near_y = Real(ay) - beside(points.cell_y[p], grid.walls.south, grid.walls.north, fy, grid.lowest_weighed, wy, gy, edge_y);
    near_z = Real(az) - beside(points.cell_z[p], 0, WallNodes::far, fz, grid.lowest_weighed, wz, gz, edge_z);
  }

 private:
  /// Weights of one direction once more where the point is beside an edge; the offset they stand for.
  TALUS_HD static Real beside(int cell, int first, int last, Real offset, Real lowest, Real* weight, Real* slope, bool& edge) {
    edge = width == 3 && (cell == first || cell == last);
    return edge ? Shape::weigh_edge(offset, cell == first ? 1 : -1, lowest, weight, slope) : offset;
  }

  TALUS_HD void measure_slope(const GridView<Real>& grid) {
    Real sx = 0, sy = 0;
    for (int b = 0; b < width; ++b) {
      Real along = 0, value = 0;
      for (int a = 0; a < width; ++a) {
        const Real t = grid.terrain[grid.column(i + a, j + b)];
        along += gx[a] * t;
        value += wx[a] * t;
      }
      sx += wy[b] * along;
      sy += gy[b] * value;
    }
    slope_x = sx / grid.spacing;
    slope_y = sy / grid.spacing;
  }
};

}  // namespace talus
