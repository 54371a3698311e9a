// Loops over the columns of the grid's blocks: one thread a column on the CPU; on a GPU eight threads share a column's
// layers, of which a small scene has more than it has columns.
#pragma once

#include "solver/parallel/for_each.hpp"

namespace talus {

/// A loop body over the columns of a block, one after the other. `columns` of a block is how many it has. A kernel has
/// - Column: a column as it sees it, with bool inside, int first and last (one behind the last layer);
/// - locate(c): makes it, c = block * columns + the column's place in the block;
/// - Sums: of its layers, with +=;
/// - layer(column, k, sums): what happens in layer k;
/// - finish(column, sums): what happens once all layers are done.
template <class Kernel>
struct WholeColumn {
  using Named = Kernel;
  Kernel kernel;
  /// The memory that the kernel moves for that many columns [bytes]; see kernel_bytes().
  double bytes(int columns) const { return kernel_bytes(kernel, columns); }
  TALUS_HD void operator()(int c) const {
    const typename Kernel::Column column = kernel.locate(c);
    if (!column.inside) return;
    typename Kernel::Sums sums;
    for (int k = column.first; k < column.last; ++k) kernel.layer(column, k, sums);
    kernel.finish(column, sums);
  }
};

/// This function runs a kernel over the columns of `blocks` blocks; see WholeColumn for what a kernel has.
template <int columns, class Kernel>
void for_each_column(const CpuDevice& device, int blocks, const Kernel& kernel) {
  for_each(device, blocks * columns, WholeColumn<Kernel>{kernel});
}

/// A loop body that goes through each column twice, the second time knowing what it holds. Besides the members that
/// WholeColumn names, but for finish(), a kernel has
/// - Pass: what the second time needs;
/// - between(column, sums): makes it;
/// - again(column, pass, k): what happens in layer k the second time;
/// - finish(column, sums, pass): what happens once for the column, at any time after between().
template <class Kernel>
struct ColumnTwice {
  using Named = Kernel;
  Kernel kernel;
  /// The memory that the kernel moves for that many columns [bytes]; see kernel_bytes().
  double bytes(int columns) const { return kernel_bytes(kernel, columns); }
  TALUS_HD void operator()(int c) const {
    const typename Kernel::Column column = kernel.locate(c);
    if (!column.inside) return;
    typename Kernel::Sums sums;
    for (int k = column.first; k < column.last; ++k) kernel.layer(column, k, sums);
    const typename Kernel::Pass pass = kernel.between(column, sums);
    for (int k = column.first; k < column.last; ++k) kernel.again(column, pass, k);
    kernel.finish(column, sums, pass);
  }
};

/// This function runs a kernel twice over the layers of the columns of `blocks` blocks; see ColumnTwice for what a
/// kernel has.
template <int columns, class Kernel>
void for_each_column_twice(const CpuDevice& device, int blocks, const Kernel& kernel) {
  for_each(device, blocks * columns, ColumnTwice<Kernel>{kernel});
}

#if defined(__CUDACC__)
namespace detail {
inline constexpr int column_shares = 8;

template <int columns, class Kernel>
__global__ void run_columns(Kernel kernel) {
  begin_kernel();
  using Sums = typename Kernel::Sums;
  __shared__ alignas(16) unsigned char room[column_shares * columns * sizeof(Sums)];
  auto* const shared = reinterpret_cast<Sums*>(room);
  const int thread = static_cast<int>(threadIdx.x), share = thread / columns;
  const typename Kernel::Column column = kernel.locate(static_cast<int>(blockIdx.x) * columns + thread % columns);
  Sums sums;
  if (column.inside) {
    for (int k = column.first + share; k < column.last; k += column_shares) kernel.layer(column, k, sums);
  }
  shared[thread] = sums;
  __syncthreads();
  if (share > 0 || !column.inside) return;
  for (int s = 1; s < column_shares; ++s) sums += shared[thread + s * columns];
  kernel.finish(column, sums);
}

template <int columns, class Kernel>
__global__ void run_columns_twice(Kernel kernel) {
  begin_kernel();
  using Sums = typename Kernel::Sums;
  __shared__ alignas(16) unsigned char room[column_shares * columns * sizeof(Sums)];
  auto* const shared = reinterpret_cast<Sums*>(room);
  const int thread = static_cast<int>(threadIdx.x), share = thread / columns;
  const typename Kernel::Column column = kernel.locate(static_cast<int>(blockIdx.x) * columns + thread % columns);
  Sums own;
  if (column.inside) {
    for (int k = column.first + share; k < column.last; k += column_shares) kernel.layer(column, k, own);
  }
  shared[thread] = own;
  __syncthreads();
  Sums sums = shared[thread % columns];
  for (int s = 1; s < column_shares; ++s) sums += shared[thread % columns + s * columns];
  typename Kernel::Pass pass;
  if (column.inside) pass = kernel.between(column, sums);
  __syncthreads();  // between() may look at nodes that another thread changes the second time
  if (!column.inside) return;
  for (int k = column.first + share; k < column.last; k += column_shares) kernel.again(column, pass, k);
  if (share == 0) kernel.finish(column, sums, pass);
}
}  // namespace detail

/// On a GPU eight threads share a column's layers both times.
template <int columns, class Kernel>
void for_each_column_twice(const GpuDevice& device, int blocks, const Kernel& kernel) {
  if (blocks <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, blocks * columns);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_columns_twice<columns, Kernel>, blocks,
                     detail::column_shares * columns, kernel);
}

/// On a GPU eight threads share a column's layers; their sums are added in one order.
template <int columns, class Kernel>
void for_each_column(const GpuDevice& device, int blocks, const Kernel& kernel) {
  if (blocks <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, blocks * columns);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_columns<columns, Kernel>, blocks,
                     detail::column_shares * columns, kernel);
}
#endif

}  // namespace talus
