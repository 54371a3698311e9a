// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over an index on either device. A kernel is a plain struct of pointers and numbers with operator()(int index)
// const. A kernel as it is launched on a GPU is one with __device__ void run(LaunchBlock) const, which every thread of
// every block calls; where it has `most_threads` and `least_blocks`, it takes as few registers as let that many blocks
// of so many threads share a multiprocessor.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"

namespace talus {

#if defined(__CUDACC__)

/// The block of threads that a kernel's code runs in, and the number of blocks of its run, on all GPUs together.
struct LaunchBlock {
  int index, count;
};

namespace detail {
/// Every kernel's first words. From compute capability 9.0 on a kernel comes onto the device while the one before it is
/// ending (programmatic dependent launch), and waits here until that has written all; its own successor may come then.
__device__ inline void begin_kernel() {
#if __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
  asm volatile("griddepcontrol.launch_dependents;");
#endif
}

/// `first`: the first block of this launch, which is the run's unless several GPUs share it.
template <class Kernel>
__device__ __forceinline__ void run_one(const Kernel& kernel, LaunchBlock first) {
  begin_kernel();
  kernel.run({first.index + static_cast<int>(blockIdx.x), first.count});
}

template <class Kernel>
__global__ void run_kernel(Kernel kernel, LaunchBlock first) {
  run_one(kernel, first);
}
/// A GPU's share of a kernel that is short of registers, and the whole of it: where the first block is known, G2P in
/// single precision spills less and takes 4 to 15 % less time.
template <class Kernel>
__global__ __launch_bounds__(Kernel::most_threads, Kernel::least_blocks) void run_dense_share(Kernel kernel,
                                                                                              LaunchBlock first) {
  run_one(kernel, first);
}
template <class Kernel>
__global__ __launch_bounds__(Kernel::most_threads, Kernel::least_blocks) void run_dense_kernel(Kernel kernel) {
  run_one(kernel, {0, static_cast<int>(gridDim.x)});
}

/// How a kernel is laid out on a GPU.
struct LaunchShape {
  CUstream_st* stream;
  int blocks, threads;
  bool early;  ///< it may come onto the GPU while the one before it is ending
};

/// Starts a kernel that opens with begin_kernel(); cudaGetLastError() reports what fails.
template <class... Parameters>
void launch(const LaunchShape& shape, void (*kernel)(Parameters...),
            const std::type_identity_t<Parameters>&... arguments) {
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(static_cast<unsigned>(shape.blocks));
  config.blockDim = dim3(static_cast<unsigned>(shape.threads));
  config.stream = shape.stream;
  config.attrs = &early;
  constexpr int small = 200000;  // threads; with more, those that wait are in the way
  config.numAttrs = shape.early && shape.blocks * static_cast<long>(shape.threads) < small ? 1 : 0;
  static_cast<void>(cudaLaunchKernelEx(&config, kernel, arguments...));
}

/// Starts a kernel on the device, whose GPUs take as many of its blocks each.
template <class Kernel>
void gpu_launch(const GpuDevice& device, const char* where, int blocks, int threads, const Kernel& kernel) {
  const auto start = [&](CUstream_st* stream, int first, int last, bool early) {
    if (first == last) return;  // fewer blocks than GPUs
    const LaunchShape shape{stream, last - first, threads, early};
    const LaunchBlock from{first, blocks};
    if constexpr (!requires { Kernel::least_blocks; }) {
      launch(shape, run_kernel<Kernel>, kernel, from);
    } else if (last - first < blocks) {
      launch(shape, run_dense_share<Kernel>, kernel, from);
    } else {
      launch(shape, run_dense_kernel<Kernel>, kernel);
    }
  };
  const int shares = gpu_begin_shares(device, static_cast<std::int64_t>(blocks) * threads);
  if (shares == 1) {
    start(device.stream(), 0, blocks, gpu_starts_early(device));
  } else {
    const auto first_of = [&](int n) { return static_cast<int>(static_cast<std::int64_t>(blocks) * n / shares); };
    for (int n = 0; n < shares; ++n) start(gpu_share(device, n), first_of(n), first_of(n + 1), false);
    gpu_end_shares(device);
  }
  gpu_check_launch(where);
}

}  // namespace detail
#endif

namespace detail {
/// Calls kernel(i) for i in [begin, end).
template <class Kernel>
void run_range(Kernel kernel, int begin, int end) {
  for (int i = begin; i < end; ++i) kernel(i);
}

/// The same for a kernel that says it is `hot`, with all that it calls inlined, as on a GPU, and for each kind of CPU:
/// most kernels are as fast without, and compile faster.
template <class Kernel>
requires Kernel::hot __attribute__((flatten, TALUS_FOR_EACH_CPU)) void run_range(Kernel kernel, int begin, int end) {
  for (int i = begin; i < end; ++i) kernel(i);
}

/// Calls body(kernel, begin, end) for ranges of at least `grain` indices that cover [0, count), in parallel.
void cpu_parallel(int count, int grain, void (*body)(const void* kernel, int begin, int end), const void* kernel);
}  // namespace detail

/// This function runs kernel(i) for i in [0, count), in any order.
template <class Kernel>
void for_each(const CpuDevice& device, int count, const Kernel& kernel) {
  const KernelTime<CpuDevice> time(device, kernel, count);
  detail::cpu_parallel(
      count, 256,
      [](const void* k, int begin, int end) { detail::run_range(*static_cast<const Kernel*>(k), begin, end); },
      &kernel);
}

/// The same; then finish() runs once, when all of it is done.
template <class Kernel, class Finish>
void for_each_then(const CpuDevice& device, int count, const Kernel& kernel, const Finish& finish) {
  for_each(device, count, kernel);
  finish();
}

/// The ranges of points, one per occupied column block, in four colours: blocks of one colour share no grid node.
struct PointGroups {
  using Range = std::pair<int, int>;  // [begin, end) into the points
  std::vector<Range> ranges[4];
  bool in_order = false;                         ///< a GPU goes by them too, so that sums are the same on every run
  std::vector<Buffer<Range, GpuDevice>> on_gpu;  ///< the four, where a GPU goes by them
  /// The method makes a range of all neighbours of one block, by the colour of that: block_of(i) is the number of the
  /// block of i from 0 to count - 1, in order, and `across` how many of them lie beside one another.
  template <class BlockOf>
  void group(int count, int across, const BlockOf& block_of) {
    for (auto& of_colour : ranges) of_colour.clear();
    for (int begin = 0, end = 0; begin < count; begin = end) {
      const std::uint64_t block = block_of(begin), width = static_cast<std::uint64_t>(across);
      for (end = begin + 1; end < count && block_of(end) == block;) ++end;
      ranges[(block % width & 1) + 2 * (block / width & 1)].emplace_back(begin, end);
    }
  }
  void upload(const CpuDevice&) {}  ///< a CPU goes by `ranges` themselves
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
          for (int r = begin; r < end; ++r)
            detail::run_range(*data->kernel, data->ranges[r].first, data->ranges[r].second);
        },
        &body);
  }
}

/// From so many points on every multiprocessor has more to do than it can hold: throughput counts then, not latency.
inline constexpr int points_that_keep_a_gpu_busy = 65536;

#if defined(__CUDACC__)
namespace detail {
/// Threads of a block: few where there is little to do, so that every multiprocessor gets some of it.
inline int threads_for(bool busy) { return busy ? 128 : 32; }

/// Orders what this thread writes before and after; with several GPUs, for all of them.
__device__ inline void fence(bool one_gpu) { one_gpu ? __threadfence() : __threadfence_system(); }

/// Whether this block of a launch is the last one that comes here: then what the others wrote before is there to be
/// read. `ticket` is zero before a launch, and again behind it. All threads of the block have to call.
__device__ inline bool comes_last(unsigned* ticket, int blocks) {
  __shared__ bool last;
  const bool one_gpu = blocks == static_cast<int>(gridDim.x);
  __syncthreads();
  if (threadIdx.x == 0) {
    fence(one_gpu);
    const auto final = static_cast<unsigned>(blocks - 1);
    last = atomicInc_system(ticket, final) == final;
  }
  __syncthreads();
  if (last) fence(one_gpu);
  return last;
}

/// Nothing to do once a kernel has ended.
struct NoFinish {};

/// A thread for each index, as it is launched; a finish is for the first thread of the last block.
template <class Kernel, class Finish = NoFinish>
struct EachIndex {
  using Named = Kernel;
  int count;
  Kernel kernel;
  Finish finish = {};
  __device__ void run(LaunchBlock at) const {
    const int i = at.index * static_cast<int>(blockDim.x) + static_cast<int>(threadIdx.x);
    if (i < count) kernel(i);
    if constexpr (!std::is_same_v<Finish, NoFinish>) {
      if (comes_last(finish.ticket(), at.count) && threadIdx.x == 0) finish();
    }
  }
};

/// The same in as many registers as let this number of blocks of 128 threads share a multiprocessor.
template <int blocks, class Kernel, class Finish>
struct EachIndexDensely : EachIndex<Kernel, Finish> {
  static constexpr int most_threads = 128, least_blocks = blocks;
};

/// Whether that many threads keep the GPU busy.
inline bool is_busy_with(int count) { return count >= points_that_keep_a_gpu_busy; }
}  // namespace detail

/// On a GPU the kernel has one thread for each index, and as many blocks as its `dense` asks for where there are many.
/// The last block to end runs finish(); finish.ticket() is for comes_last().
template <class Kernel, class Finish>
void for_each_then(const GpuDevice& device, int count, const Kernel& kernel, const Finish& finish) {
  const KernelTime<GpuDevice> time(device, kernel, count);
  const bool busy = detail::is_busy_with(count);
  const int threads = detail::threads_for(busy), blocks = std::max((count + threads - 1) / threads, 1);
  if constexpr (requires { Kernel::dense; }) {
    if constexpr (Kernel::dense > 1) {
      if (busy) {
        return detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads,
                                  detail::EachIndexDensely<Kernel::dense, Kernel, Finish>{{count, kernel, finish}});
      }
    }
  }
  detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads,
                     detail::EachIndex<Kernel, Finish>{count, kernel, finish});
}
template <class Kernel>
void for_each(const GpuDevice& device, int count, const Kernel& kernel) {
  if (count > 0) for_each_then(device, count, kernel, detail::NoFinish{});
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
