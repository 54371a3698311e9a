// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How kernels are started on a GPU. A launched kernel is a plain struct with __device__ void run(LaunchBlock) const,
// which every thread of every block calls; where it has `most_threads` and `least_blocks`, it takes as few registers as
// let that many blocks of so many threads share a multiprocessor.
#pragma once

#include <type_traits>

#include "solver/parallel/device.hpp"

namespace talus {

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

/// Starts a kernel on the device.
template <class Kernel>
void gpu_launch(const GpuDevice& device, const char* where, int blocks, int threads, const Kernel& kernel) {
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
