// Owner of the background grid: terrain, storage of the columns that hold material, points sorted by column block.
#pragma once

#include <vector>

#include "solver/grid/bicubic.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particles.hpp"

namespace talus {

/// What the grid is made of, on the host.
struct GridShape {
  int columns = 0, rows = 0;
  double spacing = 0, layer_height = 0;  // [m]
  Mapping mapping = Mapping::terrain_following;
  GroundContact ground = GroundContact::nodes;
  bool quadratic = true;
  double lowest_weighed = 0;    // see GridView
  std::vector<double> terrain;  // ground at the nodes [m], NaN outside the domain; [rows * columns]
};

/// Terrain as the kernels use it, from a GridShape: coefficients, slopes at the nodes, where points may be.
struct GroundTables {
  double datum = 0;  // lowest ground [m]; heights below are from here
  std::vector<double> terrain, slope_x, slope_y;
  std::vector<unsigned char> open;
};
GroundTables make_ground_tables(const GridShape& shape);

/// The same between nodes on the host, at (xi, eta) in cells from node (0, 0).
GroundPoint<double> bicubic_ground(const GridShape& shape, const GroundTables& ground, double xi, double eta);

/// Ground elevation at (xi, eta), in cells from node (0, 0), as the grid's own functions interpolate it, or bicubic
/// where it is met by points [m above datum].
double ground_at(const GridShape& shape, const GroundTables& ground, double xi, double eta);

template <class Real, class Device>
class SparseGrid {
 public:
  /// `drift`: how far a point may go from home before it is sorted again [cells]. At most one on the CPU, where blocks
  /// of the same colour stand four columns apart. `in_order`: scatters give the same bits on every run on a GPU too; a
  /// drift of at most one there as well. `by_lowest_node`: points are sorted by the lowest of their nodes, where no
  /// order asks for more: with hats, those of one cell do not have the same nodes.
  SparseGrid(const Device& device, const GridShape& shape, int drift, bool in_order = false,
             bool by_lowest_node = false);

  /// Sort the points by home cell, drop those that left (the `gone` last ones after sorting), and give storage to every
  /// column and layer they reach until they have drifted too far.
  void fit(Particles<Real, Device>& points, int gone);

  const Device& device() const { return device_; }
  GridView<Real> view() const;
  /// From now on material is met at these nodes.
  void stand_walls(const WallNodes& nodes) { walls_ = nodes; }
  const GroundTables& ground() const { return ground_; }
  const GridShape& shape() const { return shape_; }
  const std::uint64_t* home() const { return keys_.data(); }
  const PointGroups& groups() const { return groups_; }
  int nodes() const { return nodes_; }
  int active_blocks() const { return active_; }
  const int* active_list() const { return active_list_.data(); }
  std::size_t bytes() const;

 private:
  void measure_extents(Particles<Real, Device>& points);
  void give_storage();
  void group_points(int count);

  Device device_;
  GridShape shape_;
  int drift_;
  bool by_lowest_node_;
  GroundTables ground_;
  WallNodes walls_;
  int blocks_x_ = 0, blocks_y_ = 0, nodes_ = 0, active_ = 0;
  Buffer<Real, Device> terrain_{device_}, slope_x_{device_}, slope_y_{device_};
  Buffer<unsigned char, Device> open_{device_};
  Buffer<BlockSlot, Device> slots_{device_};
  Buffer<int, Device> lowest_{device_}, highest_{device_}, sizes_{device_}, places_{device_}, active_list_{device_},
      order_{device_};
  Buffer<std::uint64_t, Device> keys_{device_};
  PointGroups groups_;
};

}  // namespace talus
