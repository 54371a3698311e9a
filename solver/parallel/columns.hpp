// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
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
/// - again(column, pass, k): what happens in layer k the second time.
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
  }
};

/// Runs a kernel twice over the layers of the columns of `blocks` blocks; see ColumnTwice for what a kernel has.
template <int columns, class Kernel>
void for_each_column_twice(const CpuDevice& device, int blocks, const Kernel& kernel) {
  for_each(device, blocks * columns, ColumnTwice<Kernel>{kernel});
}

#if defined(__CUDACC__)
namespace detail {
inline constexpr int column_shares = 8;

/// A column as one of the eight threads sees it that share it.
template <int columns, class Kernel>
struct SharedColumn {
  using Sums = typename Kernel::Sums;
  int share;
  typename Kernel::Column column;

  __device__ SharedColumn(const Kernel& kernel, LaunchBlock at)
      : share(static_cast<int>(threadIdx.x) / columns),
        column(kernel.locate(at.index * columns + static_cast<int>(threadIdx.x) % columns)) {}
  /// The method calls f(k) for the layers that are this thread's.
  template <class F>
  __device__ void each_layer(F&& f) const {
    for (int k = column.first + share; column.inside && k < column.last; k += column_shares) f(k);
  }
  /// The sums over all layers, added in one order, for the threads that `ask`; all threads of the block have to call.
  __device__ Sums sums(const Kernel& kernel, bool ask) const {
    __shared__ alignas(16) unsigned char room[column_shares * columns * sizeof(Sums)];
    auto* const shared = reinterpret_cast<Sums*>(room);
    Sums own;
    each_layer([&](int k) { kernel.layer(column, k, own); });
    shared[threadIdx.x] = own;
    __syncthreads();
    if (!ask) return own;
    Sums all = shared[threadIdx.x % columns];
    for (int s = 1; s < column_shares; ++s) all += shared[threadIdx.x % columns + s * columns];
    return all;
  }
};

/// A block of threads for each block of columns, as it is launched.
template <int columns, class Kernel>
struct EachColumn {
  using Named = Kernel;
  Kernel kernel;
  __device__ void run(LaunchBlock at) const {
    const SharedColumn<columns, Kernel> own(kernel, at);
    const bool finishes = own.share == 0 && own.column.inside;
    const typename Kernel::Sums sums = own.sums(kernel, finishes);
    if (finishes) kernel.finish(own.column, sums);
  }
};

/// The same for columns that are gone through twice.
template <int columns, class Kernel>
struct EachColumnTwice {
  using Named = Kernel;
  Kernel kernel;
  __device__ void run(LaunchBlock at) const {
    const SharedColumn<columns, Kernel> own(kernel, at);
    const typename Kernel::Sums sums = own.sums(kernel, own.column.inside);
    typename Kernel::Pass pass;
    if (own.column.inside) pass = kernel.between(own.column, sums);
    __syncthreads();  // between() may look at nodes that another thread changes the second time
    own.each_layer([&](int k) { kernel.again(own.column, pass, k); });
  }
};
}  // namespace detail

/// On a GPU eight threads share a column's layers both times.
template <int columns, class Kernel>
void for_each_column_twice(const GpuDevice& device, int blocks, const Kernel& kernel) {
  if (blocks <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, blocks * columns);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, detail::column_shares * columns,
                     detail::EachColumnTwice<columns, Kernel>{kernel});
}

/// On a GPU eight threads share a column's layers; their sums are added in one order.
template <int columns, class Kernel>
void for_each_column(const GpuDevice& device, int blocks, const Kernel& kernel) {
  if (blocks <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, blocks * columns);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, detail::column_shares * columns,
                     detail::EachColumn<columns, Kernel>{kernel});
}
#endif

}  // namespace talus
