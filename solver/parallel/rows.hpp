// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of many terms for each of many indices, such as a row of a matrix times a vector.
#pragma once

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/math.hpp"

namespace talus {

/// Whether a kernel of sum_rows() has nothing to do, by its member idle(); false without that member.
template <class Kernel>
TALUS_HD bool is_idle(const Kernel& kernel) {
  if constexpr (requires { kernel.idle(); }) {
    return kernel.idle();
  } else {
    return false;
  }
}

/// The loop body of sum_rows() on the CPU: one index with all its terms, in their order.
template <int parts, class Kernel>
struct WholeRow {
  using Named = Kernel;
  Kernel kernel;
  /// The memory that the kernel moves for that many rows [bytes]; see kernel_bytes().
  double bytes(int rows) const { return kernel_bytes(kernel, rows); }
  void operator()(int i) const {
    if (is_idle(kernel)) return;
    Vec3<double> sum{};
    for (int part = 0; part < parts; ++part) sum += kernel.term(i, part);
    kernel.finish(i, sum);
  }
};

/// This function calls kernel.finish(i, sum of kernel.term(i, part) for part in [0, parts)) for i in [0, count). Terms
/// are Vec3<double>; their order is fixed. Where the kernel is_idle(), nothing is done.
template <int parts, class Kernel>
void sum_rows(const CpuDevice& device, int count, const Kernel& kernel) {
  for_each(device, count, WholeRow<parts, Kernel>{kernel});
}

#if defined(__CUDACC__)
namespace detail {

/// A warp for each row, so that its loads are under way together.
template <int parts, class Kernel>
struct EachRow {
  using Named = Kernel;
  int count;
  Kernel kernel;
  __device__ void run(LaunchBlock at) const {
    constexpr int warp_size = 32;
    const int thread = static_cast<int>(threadIdx.x), lane = thread % warp_size,
              i = (at.index * static_cast<int>(blockDim.x) + thread) / warp_size;
    if (i >= count || is_idle(kernel)) return;
    Vec3<double> sum{};
    for (int part = lane; part < parts; part += warp_size) sum += kernel.term(i, part);
    for (unsigned apart = warp_size / 2; apart > 0; apart /= 2) {
      sum.x += __shfl_down_sync(0xffffffffu, sum.x, apart);
      sum.y += __shfl_down_sync(0xffffffffu, sum.y, apart);
      sum.z += __shfl_down_sync(0xffffffffu, sum.z, apart);
    }
    if (lane == 0) kernel.finish(i, sum);
  }
};

}  // namespace detail

/// On a GPU a warp sums the terms of one index, in an order that is fixed as well.
template <int parts, class Kernel>
void sum_rows(const GpuDevice& device, int count, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, count);
  constexpr int threads = 128, each = threads / 32;
  detail::gpu_launch(device, __PRETTY_FUNCTION__, (count + each - 1) / each, threads,
                     detail::EachRow<parts, Kernel>{count, kernel});
}
#endif

}  // namespace talus
