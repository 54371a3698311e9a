// Owner of the background grid: terrain, storage of the columns that hold material, points sorted by column block.
#pragma once

#include <vector>

#include "solver/grid/bicubic.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particles.hpp"

namespace talus {

/// The numbers that the grid is made of, on the host.
struct GridShape {
  int columns = 0, rows = 0;
  double spacing = 0, layer_height = 0;  ///< [m]
  Mapping mapping = Mapping::terrain_following;
  GroundContact ground = GroundContact::nodes;
  bool quadratic = true;
  double lowest_weighed = 0;    ///< see GridView
  std::vector<double> terrain;  ///< ground at the nodes [m], NaN outside the domain; [rows * columns]
};

/// The terrain as kernels use it, from a GridShape: coefficients, slopes at the nodes, where points may be; each
/// [rows * columns].
struct GroundTables {
  double datum = 0;  ///< lowest ground [m]; heights below are from here
  std::vector<double> terrain, slope_x, slope_y;
  std::vector<unsigned char> open;
};
/// The terrain of a grid: elevations at the nodes above the datum, the coefficients b_i of (T1), and the slopes there.
GroundTables make_ground_tables(const GridShape& shape);

/// The bicubic ground on the host, at (xi, eta) in cells from node (0, 0).
GroundPoint<double> bicubic_ground(const GridShape& shape, const GroundTables& ground, double xi, double eta);

/// The ground elevation at (xi, eta), in cells from node (0, 0), as the grid's own functions interpolate it (T1), or
/// bicubic where it is met by points [m above datum].
double ground_at(const GridShape& shape, const GroundTables& ground, double xi, double eta);

/// The background grid with its storage, and the order of the points in it.
template <class Real, class Device>
class SparseGrid {
 public:
  /// The constructor makes a grid without points. `drift` is how far a point may go from home before it is sorted again
  /// [cells], at most one on the CPU, where blocks of the same colour are four columns apart. With `in_order` scatters
  /// give the same bits on every run on a GPU too; the drift is at most one there as well. With `by_lowest_node` points
  /// are sorted by the lowest of their nodes, where no order asks for more: with hats, those of one cell do not have
  /// the same nodes.
  SparseGrid(const Device& device, const GridShape& shape, int drift, bool in_order = false,
             bool by_lowest_node = false);

  /// The method sorts the points by home cell, drops those that left (the `gone` last ones after sorting), and gives
  /// storage to every column and layer they reach until they have drifted too far.
  void fit(Particles<Real, Device>& points, int gone);

  /// The device that the grid is on.
  const Device& device() const { return device_; }
  /// The grid as kernels see it, until the next fit().
  GridView<Real> view() const;
  /// The method sets the nodes at which material is met from now on.
  void stand_walls(const WallNodes& nodes) { walls_ = nodes; }
  /// The terrain as kernels use it, on the host.
  const GroundTables& ground() const { return ground_; }
  /// The shape of the grid.
  const GridShape& shape() const { return shape_; }
  /// The keys of the cells that the points were sorted by (home_key()), [points] on the device.
  const std::uint64_t* home() const { return keys_.data(); }
  /// The ranges of points by column block and colour.
  const PointGroups& groups() const { return groups_; }
  /// The number of stored nodes.
  int nodes() const { return nodes_; }
  /// The number of column blocks with storage.
  int active_blocks() const { return active_; }
  /// The column blocks with storage, [active_blocks()] on the device.
  const int* active_list() const { return active_list_.data(); }
  /// The size of the storage and of the tables [bytes].
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
