// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small grid and a point in it, in the test's own memory, for what one thread of a kernel does.
#pragma once

#include "solver/state/particles.hpp"

namespace talus::solver::testing {

/// A grid of 8 x 8 columns and 8 layers over a plane, stored as a whole.
struct SmallGrid {
  static constexpr int side = 8, layers = 8, nodes = side * side * layers;
  static constexpr std::size_t column = 2 * side + 5;        ///< (5, 2), the one that tests of columns fill
  double spacing = 2, layer_height = 0.5, along_x, along_y;  ///< [m]; slopes of the plane [-]
  std::vector<double> terrain, slope_x, slope_y;
  std::vector<unsigned char> open;
  std::vector<BlockSlot> slots;
  std::vector<int> active{0, 1, 2, 3};

  explicit SmallGrid(double along_x_ = 0, double along_y_ = 0)
      : along_x(along_x_),
        along_y(along_y_),
        slope_x(side * side, along_x_),
        slope_y(side * side, along_y_),
        open(side * side, 1) {
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) terrain.push_back(place(i, j, 0).z);
    for (int block = 0; block < 4; ++block) slots.push_back({block * layers * block_columns, 0, layers});
  }
  /// The place of a node or of anything else that has numbers in the grid [m].
  Vec3<double> place(double i, double j, double k) const {
    return {i * spacing, j * spacing, (along_x * i + along_y * j) * spacing + k * layer_height};
  }
  /// The grid as kernels see it.
  GridView<double> view() const {
    GridView<double> v;
    v.columns = v.rows = side;
    v.block_columns_x = 2;
    v.nodes = nodes;
    v.spacing = spacing;
    v.layer_height = layer_height;
    v.slots = slots.data();
    v.terrain = terrain.data();
    v.slope_x = slope_x.data();
    v.slope_y = slope_y.data();
    v.open = open.data();
    return v;
  }
  /// A field over the stored nodes, from its values at places.
  template <class Field>
  std::vector<Vec3<double>> sample(const Field& field) const {
    std::vector<Vec3<double>> values(nodes);
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        for (int k = 0; k < layers; ++k) values[static_cast<std::size_t>(view().find(i, j, k))] = field(place(i, j, k));
    return values;
  }
};

/// A point with what every point has, and the box of one.
struct OnePoint {
  int cell[3] = {3, 4, 3}, id = 0;
  double offset[3] = {0.2, -0.35, 0.4}, velocity[3] = {}, elastic[6] = {}, extent[3] = {0.5, 0.5, 0.5};
  double log_volume = 0, volume = 0.25;

  /// The point as kernels see it.
  ParticleView<double> view() {
    ParticleView<double> v;
    for (int a = 0; a < 3; ++a) {
      v.cell[a] = &cell[a];
      v.offset[a] = &offset[a];
      v.velocity[a] = &velocity[a];
      v.extent[a] = &extent[a];
    }
    for (int a = 0; a < 6; ++a) v.elastic[a] = &elastic[a];
    v.log_volume = &log_volume;
    v.volume = &volume;
    v.id = &id;
    return v;
  }
  /// The place of the point [m].
  Vec3<double> place(const SmallGrid& grid) const {
    return grid.place(cell[0] + offset[0], cell[1] + offset[1], cell[2] + offset[2]);
  }
};

/// Points in the middle of the grid and beside the ground.
inline std::vector<OnePoint> some_points() {
  std::vector<OnePoint> points(3);
  points[1].cell[2] = 0;  // offset 0.4: the box ends above the ground
  points[2].offset[0] = -0.45;
  points[2].offset[2] = -0.1;
  return points;
}

}  // namespace talus::solver::testing
