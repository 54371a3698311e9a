// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over a range of indices that are finished on the device where they are made: a loop there needs nothing from the
// host.
#pragma once

#include <algorithm>

#include "solver/parallel/for_each.hpp"

namespace talus {

/// The terms that one index adds to K sums.
template <int K>
struct Terms {
  double value[static_cast<std::size_t>(K)] = {};
};

/// A finish that leaves the totals where they can be read.
template <int K>
struct KeepTotals {
  double* at;
  TALUS_HD void operator()(const double* total) const {
    for (int k = 0; k < K; ++k) at[k] = total[k];
  }
};

template <class Device>
class SumSpace {
 public:
  explicit SumSpace(const Device& device) : partial_(device), ticket_(device) {}
  double* partial(int count) {
    partial_.resize(static_cast<std::size_t>(count));
    return partial_.data();
  }
  /// The counter of the blocks that are done; zero between sums.
  unsigned* ticket() {
    if (ticket_.size() == 0) ticket_.upload({0u});
    return ticket_.data();
  }
  const Device& device() const { return partial_.device(); }  ///< device whose memory it is
  std::size_t bytes() const { return partial_.bytes() + ticket_.bytes(); }

 private:
  Buffer<double, Device> partial_;
  Buffer<unsigned, Device> ticket_;
};

/// Sums body(i), Terms<K>, for i in [0, count), and calls finish(const double* total) once, by one thread. The order is
/// fixed by `count` alone, so that a run repeats to the bit. A body may as well write what belongs to its index.
template <int K, class Body, class Finish>
void sum_each(const CpuDevice& device, int count, SumSpace<CpuDevice>& space, const Body& body, const Finish& finish) {
  const KernelTime<CpuDevice> time(device, body, count);
  constexpr int grain = 512;
  const int chunks = (count + grain - 1) / grain;
  struct Job {
    const Body* body;
    double* partial;
    int count;
  } job{&body, space.partial(K * std::max(chunks, 1)), count};
  detail::cpu_parallel(
      chunks, 1,
      [](const void* data, int begin, int end) {
        const Job& j = *static_cast<const Job*>(data);
        const Body local = *j.body;
        for (int chunk = begin; chunk < end; ++chunk) {
          double sums[static_cast<std::size_t>(K)] = {};
          for (int i = chunk * grain; i < std::min((chunk + 1) * grain, j.count); ++i) {
            const Terms<K> terms = local(i);
            for (int k = 0; k < K; ++k) sums[k] += terms.value[k];
          }
          for (int k = 0; k < K; ++k) j.partial[K * chunk + k] = sums[k];
        }
      },
      &job);
  double total[static_cast<std::size_t>(K)] = {};
  for (int chunk = 0; chunk < chunks; ++chunk) {
    for (int k = 0; k < K; ++k) total[k] += job.partial[K * chunk + k];
  }
  finish(static_cast<const double*>(total));
}

#if defined(__CUDACC__)
namespace detail {

/// Sum over the threads of a block, in thread 0.
template <int K>
__device__ void sum_block(double (&sums)[static_cast<std::size_t>(K)]) {
  __shared__ double warps[K][32];
  const unsigned lane = threadIdx.x % 32, warp = threadIdx.x / 32, count = blockDim.x / 32;
  for (int k = 0; k < K; ++k) {
    for (unsigned apart = 16; apart > 0; apart /= 2) sums[k] += __shfl_down_sync(0xffffffffu, sums[k], apart);
    if (lane == 0) warps[k][warp] = sums[k];
  }
  __syncthreads();
  if (warp == 0) {
    for (int k = 0; k < K; ++k) {
      sums[k] = lane < count ? warps[k][lane] : 0.0;
      for (unsigned apart = 16; apart > 0; apart /= 2) sums[k] += __shfl_down_sync(0xffffffffu, sums[k], apart);
    }
  }
  __syncthreads();
}

/// The sum of a body over all indices, as it is launched.
template <int K, class Body, class Finish>
struct SumEach {
  using Named = Body;
  int count;
  Body body;
  Finish finish;
  double* partial;
  unsigned* ticket;
  __device__ void run(LaunchBlock at) const {
    double sums[K] = {};
    const int threads = static_cast<int>(blockDim.x), thread = static_cast<int>(threadIdx.x);
    for (int i = at.index * threads + thread; i < count; i += at.count * threads) {
      const Terms<K> terms = body(i);
      for (int k = 0; k < K; ++k) sums[k] += terms.value[k];
    }
    sum_block<K>(sums);
    if (thread == 0) {
      for (int k = 0; k < K; ++k) partial[k * at.count + at.index] = sums[k];
    }
    if (!comes_last(ticket, at.count)) return;
    for (int k = 0; k < K; ++k) {
      sums[k] = 0;
      for (int b = thread; b < at.count; b += threads) sums[k] += __ldcg(&partial[k * at.count + b]);
    }
    sum_block<K>(sums);
    if (thread == 0) finish(static_cast<const double*>(sums));
  }
};

}  // namespace detail

/// On a GPU up to 512 blocks sum in turns, and the last one to end adds up what they found.
template <int K, class Body, class Finish>
void sum_each(const GpuDevice& device, int count, SumSpace<GpuDevice>& space, const Body& body, const Finish& finish) {
  constexpr int most_blocks = 512,
                threads = 256;  // the last block adds up what all have found: few blocks, many threads
  const int blocks = std::clamp((count + threads - 1) / threads, 1, most_blocks);
  const KernelTime<GpuDevice> time(device, body, count);
  detail::gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads,
                     detail::SumEach<K, Body, Finish>{.count = count,
                                                      .body = body,
                                                      .finish = finish,
                                                      .partial = space.partial(K * most_blocks),
                                                      .ticket = space.ticket()});
}
#endif

}  // namespace talus
