// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/grid/sparse_grid.hpp"

namespace talus {

template <class Real, class Device>
SparseGrid<Real, Device>::SparseGrid(const Device& device, const GridShape& shape, const Drift& drift, bool in_order,
                                     bool by_lowest_node)
    : device_(device),
      shape_(shape),
      drift_(drift),
      tables_(make_terrain_tables(shape)),
      terrain_(device, tables_),
      storage_(device, shape.columns, shape.rows),
      order_(device, shape.columns, shape.rows, {.in_order = in_order, .by_lowest_node = by_lowest_node}) {}

template <class Real, class Device>
GridView<Real> SparseGrid<Real, Device>::view() const {
  GridView<Real> v;
  v.columns = shape_.columns;
  v.rows = shape_.rows;
  v.block_columns_x = blocks_across(shape_.columns);
  v.nodes = storage_.nodes();
  v.spacing = static_cast<Real>(shape_.spacing);
  v.layer_height = static_cast<Real>(shape_.layer_height);
  v.lowest_weighed = static_cast<Real>(shape_.lowest_weighed);
  v.drift = drift_.columns;
  v.climb = drift_.layers;
  v.homes_below = order_.by_lowest_node();
  v.walls = walls_;
  v.mapping = shape_.mapping;
  v.slots = storage_.slots();
  terrain_.show(v);
  return v;
}

template <class Real, class Device>
void SparseGrid<Real, Device>::fit(Particles<Real, Device>& points, int outflow_count) {
  order_.sort(points, outflow_count);
  storage_.fit(points.view(), {.columns = 1 + drift_.columns, .layers = 1 + drift_.layers});
}

template class SparseGrid<float, CpuDevice>;
template class SparseGrid<double, CpuDevice>;
#if TALUS_FOR_GPU
template class SparseGrid<float, GpuDevice>;
template class SparseGrid<double, GpuDevice>;
#endif

}  // namespace talus
