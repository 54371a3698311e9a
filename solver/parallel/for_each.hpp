// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over an index on either device. A kernel is a plain struct of pointers and numbers with operator()(int index)
// const.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/device.hpp"
#include "solver/parallel/launch.hpp"
#include "solver/parallel/macros.hpp"
#include "solver/parallel/profile.hpp"

namespace talus {

namespace detail {
/// Calls body(kernel, begin, end) for ranges of at least `grain` indices that cover [0, count), in parallel.
void cpu_parallel(int count, int grain, void (*body)(const void* kernel, int begin, int end), const void* kernel);
}  // namespace detail

/// This function runs kernel(i) for i in [0, count), in any order.
template <class Kernel>
void for_each(const CpuDevice& device, int count, const Kernel& kernel) {
  const KernelTime<CpuDevice> time(device, kernel, count);
  detail::cpu_parallel(
      count, 256,
      [](const void* k, int begin, int end) TALUS_FLATTEN {
        const Kernel local = *static_cast<const Kernel*>(k);
        for (int i = begin; i < end; ++i) local(i);
      },
      &kernel);
}

/// The ranges of points, one per occupied column block, in four colours: blocks of one colour share no grid node.
struct PointGroups {
  using Range = std::pair<int, int>;  // [begin, end) into the points
  std::vector<Range> ranges[4];
  bool in_order = false;                         ///< a GPU goes by them too, so that sums are the same on every run
  std::vector<Buffer<Range, GpuDevice>> on_gpu;  ///< the four, where a GPU goes by them
  /// The CPU goes by `ranges` themselves; nothing is copied.
  void upload(const CpuDevice&) {}
  /// The method copies the ranges to a GPU where that goes by them too, one buffer for each colour.
  void upload(const GpuDevice& device) {
    while (on_gpu.size() < 4) on_gpu.emplace_back(device);
    for (std::size_t c = 0; in_order && c < 4; ++c) on_gpu[c].upload(ranges[c]);
  }
};

/// This function runs kernel(p) over all points such that scatter_add never meets itself. CPU: colour by colour, each
/// block in order, so sums are the same on every run. GPU: all at once, with atomics; with groups.in_order as the CPU,
/// a thread for every block.
template <class Kernel>
void for_each_grouped(const CpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel) {
  const KernelTime<CpuDevice> time(device, kernel, count);
  for (const auto& ranges : groups.ranges) {
    struct Body {
      const Kernel* kernel;
      const std::pair<int, int>* ranges;
    } body{&kernel, ranges.data()};
    detail::cpu_parallel(
        static_cast<int>(ranges.size()), 1,
        [](const void* b, int begin, int end) TALUS_FLATTEN {
          const Body* data = static_cast<const Body*>(b);
          const Kernel local = *data->kernel;
          for (int r = begin; r < end; ++r) {
            for (int p = data->ranges[r].first; p < data->ranges[r].second; ++p) local(p);
          }
        },
        &body);
  }
}

/// From so many points on every multiprocessor has more to do than it can hold: what counts then is how much gets
/// through, not how soon.
inline constexpr int points_that_keep_a_gpu_busy = 65536;

#if defined(__CUDACC__)
namespace detail {
/// Threads of a block: few where there is little to do, so that every multiprocessor gets some of it.
inline int threads_for(bool busy) { return busy ? 128 : 32; }

/// A thread for each index, as it is launched.
template <class Kernel>
struct EachIndex {
  using Named = Kernel;
  int count;
  Kernel kernel;
  __device__ void run(LaunchBlock at) const {
    const int i = at.index * static_cast<int>(blockDim.x) + static_cast<int>(threadIdx.x);
    if (i < count) kernel(i);
  }
};

/// The same in as many registers as let this number of blocks of 128 threads share a multiprocessor.
template <int blocks, class Kernel>
struct EachIndexDensely : EachIndex<Kernel> {
  static constexpr int most_threads = 128, least_blocks = blocks;
};

/// Whether that many threads keep the GPU busy.
inline bool is_busy_with(int count) { return count >= points_that_keep_a_gpu_busy; }
}  // namespace detail

/// On a GPU the kernel has one thread for each index, and as many blocks as its member `dense` asks for where there are
/// many.
template <class Kernel>
void for_each(const GpuDevice& device, int count, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, count);
  const bool busy = detail::is_busy_with(count);
  const int threads = detail::threads_for(busy), blocks = (count + threads - 1) / threads;
  if constexpr (requires { Kernel::dense; }) {
    if (Kernel::dense > 0 && busy) {
      return detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads,
                                detail::EachIndexDensely<Kernel::dense, Kernel>{{count, kernel}});
    }
  }
  detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads, detail::EachIndex<Kernel>{count, kernel});
}

/// One thread: the points of a block, one after the other.
template <class Kernel>
struct InOrder {
  using Named = Kernel;
  Kernel kernel;
  const PointGroups::Range* ranges;
  TALUS_HD void operator()(int r) const {
    const int begin = ranges[r].first, end = ranges[r].second;
    for (int p = begin; p < end; ++p) kernel(p);
  }
};

/// On a GPU all points run at once, or with groups.in_order one thread for each block, colour by colour.
template <class Kernel>
void for_each_grouped(const GpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel) {
  if (!groups.in_order) return for_each(device, count, kernel);
  for (const auto& ranges : groups.on_gpu)
    for_each(device, static_cast<int>(ranges.size()), InOrder<Kernel>{kernel, ranges.data()});
}
#endif

}  // namespace talus
