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
      [](const void* k, int begin, int end) {
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
        [](const void* b, int begin, int end) {
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
/// Every kernel's first words. From compute capability 9.0 on a kernel comes onto the device while the one before it is
/// ending (programmatic dependent launch), and waits here until that has written all it had to; its own successor may
/// come then.
__device__ inline void begin_kernel() {
#if __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
  asm volatile("griddepcontrol.launch_dependents;");
#endif
}

/// Starts a kernel that opens with begin_kernel().
template <class... Parameters>
void gpu_launch(const GpuDevice& device, const char* where, void (*kernel)(Parameters...), int blocks, int threads,
                const std::type_identity_t<Parameters>&... arguments) {
  gpu_select(device);
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(static_cast<unsigned>(blocks));
  config.blockDim = dim3(static_cast<unsigned>(threads));
  config.stream = device.stream();
  config.attrs = &early;
  constexpr int small = 200000;  // threads; with more, those that wait are in the way
  config.numAttrs = gpu_starts_early(device) && blocks * static_cast<long>(threads) < small ? 1 : 0;
  static_cast<void>(cudaLaunchKernelEx(&config, kernel, arguments...));  // gpu_check_launch reports it
  gpu_check_launch(where);
}

/// Threads of a block: few where there is little to do, so that every multiprocessor gets some of it.
inline int threads_for(int count) { return count < 65536 ? 32 : 128; }

template <class Kernel>
__global__ void run_kernel(int count, Kernel kernel) {
  begin_kernel();
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}

/// The same in as many registers as let this number of blocks of 128 threads share a multiprocessor.
template <int blocks, class Kernel>
__global__ __launch_bounds__(128, blocks) void run_dense(int count, Kernel kernel) {
  begin_kernel();
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}
}  // namespace detail

/// On a GPU the kernel has one thread for each index, and as many blocks as its member `dense` asks for where there are
/// many.
template <class Kernel>
void for_each(const GpuDevice& device, int count, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, count);
  if constexpr (requires { Kernel::dense; }) {
    if (Kernel::dense > 0 && count >= points_that_keep_a_gpu_busy) {
      return detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_dense<Kernel::dense, Kernel>,
                                (count + 127) / 128, 128, count, kernel);
    }
  }
  const int threads = detail::threads_for(count);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_kernel<Kernel>, (count + threads - 1) / threads, threads,
                     count, kernel);
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
