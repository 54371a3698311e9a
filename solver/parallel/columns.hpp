// Loops over the columns of the grid's blocks: one thread a column on the CPU; on a GPU eight threads share a column's
// layers, of which a small scene has more than it has columns.
#pragma once

#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// Runs kernel over the columns of `blocks` blocks in use. The kernel has
///   Column                    a column as it sees it: bool inside, int first, last (one behind the last layer); made
///   by locate(c), c = block * 16 + column in it Sums                      of its layers, with += layer(column, k,
///   sums)    what happens in a layer finish(column, sums)      what happens once all layers are done
template <class Kernel>
struct WholeColumn {
  using Named = Kernel;
  Kernel kernel;
  double bytes(int columns) const { return kernel_bytes(kernel, columns); }
  TALUS_HD void operator()(int c) const {
    const typename Kernel::Column column = kernel.locate(c);
    if (!column.inside) return;
    typename Kernel::Sums sums;
    for (int k = column.first; k < column.last; ++k) kernel.layer(column, k, sums);
    kernel.finish(column, sums);
  }
};

template <class Kernel>
void for_each_column(const CpuDevice& device, int blocks, const Kernel& kernel) {
  for_each(device, blocks * block_columns, WholeColumn<Kernel>{kernel});
}

#if defined(__CUDACC__)
namespace detail {
inline constexpr int column_shares = 8;

template <class Kernel>
__global__ void run_columns(Kernel kernel) {
  begin_kernel();
  using Sums = typename Kernel::Sums;
  __shared__ alignas(16) unsigned char room[column_shares * block_columns * sizeof(Sums)];
  auto* const shared = reinterpret_cast<Sums*>(room);
  const int thread = static_cast<int>(threadIdx.x), share = thread / block_columns;
  const typename Kernel::Column column =
      kernel.locate(static_cast<int>(blockIdx.x) * block_columns + thread % block_columns);
  Sums sums;
  if (column.inside) {
    for (int k = column.first + share; k < column.last; k += column_shares) kernel.layer(column, k, sums);
  }
  shared[thread] = sums;
  __syncthreads();
  if (share > 0 || !column.inside) return;
  for (int s = 1; s < column_shares; ++s) sums += shared[thread + s * block_columns];
  kernel.finish(column, sums);
}
}  // namespace detail

template <class Kernel>
void for_each_column(const GpuDevice& device, int blocks, const Kernel& kernel) {
  if (blocks <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, blocks * block_columns);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_columns<Kernel>, blocks,
                     detail::column_shares * block_columns, kernel);
}
#endif

}  // namespace talus
