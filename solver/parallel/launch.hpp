// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How kernels are started on a GPU: of one run, or those of several runs as one. A launched kernel is a plain struct
// with __device__ void run(LaunchBlock) const, which every thread of every block calls; where it has `most_threads` and
// `least_blocks`, it takes as few registers as let that many blocks of so many threads share a multiprocessor.
#pragma once

#include <type_traits>

#include "solver/parallel/device.hpp"
#include "solver/parallel/launch_list.hpp"

namespace talus {

/// Whether a kernel can be started with the same one of other runs, by its `with_other_runs`, or that of what it wraps.
/// Such a kernel is compiled twice; it is asked for where many small runs share a GPU.
template <class Kernel>
constexpr bool runs_with_others() {
  if constexpr (requires { Kernel::with_other_runs; }) {
    return Kernel::with_other_runs;
  } else if constexpr (requires { typename Kernel::Named; }) {
    return runs_with_others<typename Kernel::Named>();
  } else {
    return false;
  }
}

namespace detail {
/// The list that keeps what is started on the device, instead of a start; null where it is started.
LaunchList* gpu_kept(const GpuDevice& device);
}  // namespace detail

#if defined(__CUDACC__)

/// The block of threads that a kernel's code runs in, and the number of blocks of its run.
struct LaunchBlock {
  int index, count;
};

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

template <class Kernel>
__device__ __forceinline__ void run_one(const Kernel& kernel) {
  begin_kernel();
  kernel.run({static_cast<int>(blockIdx.x), static_cast<int>(gridDim.x)});
}

template <class Kernel>
__global__ void run_kernel(Kernel kernel) {
  run_one(kernel);
}
template <class Kernel>
__global__ __launch_bounds__(Kernel::most_threads, Kernel::least_blocks) void run_dense_kernel(Kernel kernel) {
  run_one(kernel);
}

template <class Kernel>
__device__ __forceinline__ void run_own(const int* __restrict__ ends, const Kernel* __restrict__ kernels) {
  begin_kernel();
  constexpr unsigned all = 0xffffffffu;
  static_assert(LaunchTable::most == 32, "one run for each lane");
  const int block = static_cast<int>(blockIdx.x), end = ends[threadIdx.x % 32];
  const int run = __popc(__ballot_sync(all, block >= end));
  const int own = __shfl_sync(all, end, run), before = __shfl_sync(all, end, run - 1), first = run > 0 ? before : 0;
  if (run == LaunchTable::most || own == no_block) return;
  kernels[run].run({block - first, own - first});
}

template <class Kernel>
__global__ void run_several(const int* __restrict__ ends, const Kernel* __restrict__ kernels) {
  run_own(ends, kernels);
}
template <class Kernel>
__global__ __launch_bounds__(Kernel::most_threads,
                             Kernel::least_blocks) void run_several_dense(const int* __restrict__ ends,
                                                                          const Kernel* __restrict__ kernels) {
  run_own(ends, kernels);
}

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

/// Starts the kernels of several runs as one; a StartSeveral.
template <class Kernel>
void start_several(const LaunchShape& shape, const LaunchTable& table) {
  const auto* const kernels = static_cast<const Kernel*>(table.kernels);
  if constexpr (requires { Kernel::least_blocks; }) {
    launch(shape, run_several_dense<Kernel>, table.ends, kernels);
  } else {
    launch(shape, run_several<Kernel>, table.ends, kernels);
  }
}

/// Starts a kernel on the device, or keeps it in the device's list.
template <class Kernel>
void gpu_launch(const GpuDevice& device, const char* where, int blocks, int threads, const Kernel& kernel) {
  if (LaunchList* const list = gpu_kept(device)) {
    if constexpr (runs_with_others<Kernel>()) {
      list->add(kernel, blocks, threads, start_several<Kernel>);
    } else {
      list->leave_out(where);
    }
    return;
  }
  gpu_select(device);
  const LaunchShape shape{device.stream(), blocks, threads, gpu_starts_early(device)};
  if constexpr (requires { Kernel::least_blocks; }) {
    launch(shape, run_dense_kernel<Kernel>, kernel);
  } else {
    launch(shape, run_kernel<Kernel>, kernel);
  }
  gpu_check_launch(where);
}

}  // namespace detail
#endif

}  // namespace talus
