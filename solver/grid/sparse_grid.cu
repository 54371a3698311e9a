#include "solver/grid/sparse_grid.hpp"

#include <bit>

#include "solver/parallel/algorithms.hpp"

namespace talus {
namespace {

constexpr int no_layer_low = 0x7fffffff;
constexpr int no_layer_high = -1;

template <class Real>
struct MakeKeys {
  ParticleView<Real> points;
  int blocks_x;
  bool by_lowest_node;  // of hats; else by the nearest one
  std::uint64_t* keys;
  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p], j = points.cell[1][p], k = points.cell[2][p];
    const bool x = points.offset[0][p] < Real(0), y = points.offset[1][p] < Real(0), z = points.offset[2][p] < Real(0);
    if (i < 0) {
      keys[p] = ~std::uint64_t{0};
    } else if (by_lowest_node) {
      keys[p] = home_key(blocks_x, i - (x && i > 0), j - (y && j > 0), k - (z && k > 0));
    } else {
      keys[p] = home_key(blocks_x, i, j, k, (x ? 0 : 1) + (y ? 0 : 2) + (z ? 0 : 4));
    }
  }
};

struct ForgetExtents {
  int* lowest;
  int* highest;
  TALUS_HD void operator()(int b) const {
    lowest[b] = no_layer_low;
    highest[b] = no_layer_high;
  }
};

/// A point reaches a column and a layer beyond the way it may go before the next sort: that of its stencil.
template <class Real>
struct MeasureExtents {
  ParticleView<Real> points;
  int columns, rows, blocks_x, reach;
  int* lowest;
  int* highest;
  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p], j = points.cell[1][p], k = points.cell[2][p];
    const int i0 = i > reach ? i - reach : 0, i1 = i + reach < columns ? i + reach : columns - 1;
    const int j0 = j > reach ? j - reach : 0, j1 = j + reach < rows ? j + reach : rows - 1;
    const int k0 = k > reach ? k - reach : 0;
    for (int bj = j0 >> 2; bj <= j1 >> 2; ++bj) {
      for (int bi = i0 >> 2; bi <= i1 >> 2; ++bi) {
        atomic_min(&lowest[bj * blocks_x + bi], k0);
        atomic_max(&highest[bj * blocks_x + bi], k + reach);
      }
    }
  }
};

/// One thread: one block. It counts the nodes that the block needs, and notes whether it is in use.
struct CountNodes {
  const int* lowest;
  const int* highest;
  int* sizes;
  int* in_use;
  TALUS_HD void operator()(int b) const {
    const bool used = highest[b] >= lowest[b];
    sizes[b] = used ? (highest[b] - lowest[b] + 1) * block_columns : 0;
    in_use[b] = used ? 1 : 0;
  }
};

struct GiveStorage {
  const int* lowest;
  const int* highest;
  const int* offsets;
  const int* places;
  BlockSlot* slots;
  int* active;
  TALUS_HD void operator()(int b) const {
    if (highest[b] < lowest[b]) {
      slots[b] = BlockSlot{};
      return;
    }
    slots[b] = BlockSlot{offsets[b], lowest[b], highest[b] - lowest[b] + 1};
    active[places[b]] = b;
  }
};

}  // namespace

template <class Real, class Device>
SparseGrid<Real, Device>::SparseGrid(const Device& device, const GridShape& shape, int drift, bool in_order,
                                     bool by_lowest_node)
    : device_(device),
      shape_(shape),
      drift_(drift),
      by_lowest_node_(by_lowest_node && Device::is_gpu && !in_order),
      ground_(make_ground_tables(shape)) {
  groups_.in_order = in_order;
  blocks_x_ = (shape.columns + block_side - 1) / block_side;
  blocks_y_ = (shape.rows + block_side - 1) / block_side;
  upload_as(terrain_, ground_.terrain);
  upload_as(slope_x_, ground_.slope_x);
  upload_as(slope_y_, ground_.slope_y);
  open_.upload(ground_.open);
  const auto blocks = static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y_);
  for (auto* buffer : {&lowest_, &highest_, &sizes_, &places_, &active_list_}) buffer->resize(blocks);
  slots_.resize(blocks);
}

template <class Real, class Device>
GridView<Real> SparseGrid<Real, Device>::view() const {
  GridView<Real> v;
  v.columns = shape_.columns;
  v.rows = shape_.rows;
  v.block_columns_x = blocks_x_;
  v.nodes = nodes_;
  v.spacing = static_cast<Real>(shape_.spacing);
  v.layer_height = static_cast<Real>(shape_.layer_height);
  v.lowest_weighed = static_cast<Real>(shape_.lowest_weighed);
  v.drift = drift_;
  v.homes_below = by_lowest_node_;
  v.walls = walls_;
  v.mapping = shape_.mapping;
  v.ground = shape_.ground;
  v.slots = slots_.data();
  v.terrain = terrain_.data();
  v.slope_x = slope_x_.data();
  v.slope_y = slope_y_.data();
  v.open = open_.data();
  return v;
}

template <class Real, class Device>
void SparseGrid<Real, Device>::fit(Particles<Real, Device>& points, int gone) {
  keys_.resize(static_cast<std::size_t>(points.count()));
  for_each(device_, points.count(), MakeKeys<Real>{points.view(), blocks_x_, by_lowest_node_, keys_.data()});
  sort_order(device_, keys_, order_, key_block_shift + static_cast<int>(std::bit_width(slots_.size())));
  points.reorder(order_, points.count() - gone);
  measure_extents(points);
  give_storage();
  group_points(points.count());
}

template <class Real, class Device>
void SparseGrid<Real, Device>::measure_extents(Particles<Real, Device>& points) {
  for_each(device_, static_cast<int>(lowest_.size()), ForgetExtents{lowest_.data(), highest_.data()});
  for_each(device_, points.count(),
           MeasureExtents<Real>{points.view(), shape_.columns, shape_.rows, blocks_x_, 1 + drift_, lowest_.data(),
                                highest_.data()});
}

template <class Real, class Device>
void SparseGrid<Real, Device>::give_storage() {
  const int blocks = static_cast<int>(lowest_.size());
  for_each(device_, blocks, CountNodes{lowest_.data(), highest_.data(), sizes_.data(), places_.data()});
  const auto totals = exclusive_sums(device_, sizes_.data(), places_.data(), blocks);
  nodes_ = totals[0];
  active_ = totals[1];
  for_each(
      device_, blocks,
      GiveStorage{lowest_.data(), highest_.data(), sizes_.data(), places_.data(), slots_.data(), active_list_.data()});
}

template <class Real, class Device>
void SparseGrid<Real, Device>::group_points(int count) {
  if (Device::is_gpu && !groups_.in_order) return;
  std::vector<std::uint64_t> copy;
  if (Device::is_gpu) copy = keys_.download();
  const std::uint64_t* const keys = Device::is_gpu ? copy.data() : keys_.data();
  for (auto& ranges : groups_.ranges) ranges.clear();
  for (int begin = 0; begin < count;) {
    const auto block = keys[begin] >> key_block_shift;
    int end = begin + 1;
    while (end < count && keys[end] >> key_block_shift == block) ++end;
    const auto width = static_cast<std::uint64_t>(blocks_x_);
    const std::uint64_t colour = (block % width & 1) + 2 * (block / width & 1);
    groups_.ranges[colour].emplace_back(begin, end);
    begin = end;
  }
  groups_.upload(device_);
}

template <class Real, class Device>
std::size_t SparseGrid<Real, Device>::bytes() const {
  return terrain_.bytes() + slope_x_.bytes() + slope_y_.bytes() + open_.bytes() + slots_.bytes() + lowest_.bytes() +
         highest_.bytes() + sizes_.bytes() + places_.bytes() + active_list_.bytes() + order_.bytes() + keys_.bytes();
}

template class SparseGrid<float, CpuDevice>;
template class SparseGrid<double, CpuDevice>;
#if TALUS_FOR_GPU
template class SparseGrid<float, GpuDevice>;
template class SparseGrid<double, GpuDevice>;
#endif

}  // namespace talus
