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
}  // namespace detail

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
