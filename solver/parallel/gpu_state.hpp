// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a GpuDevice owns. For the CUDA files of this folder alone.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "solver/parallel/peers.hpp"
#include "solver/parallel/sums.hpp"

namespace talus {

/// Throws where the call of CUDA `what` failed: NumericalError where memory was short, std::runtime_error otherwise.
void check_cuda(cudaError_t code, const char* what);

/// The device memory of one stream's buffers, and of Thrust, whose allocator this is. What is freed is kept for the
/// next that asks: calls of CUDA wait for one another where many members of an ensemble make them.
class StreamMemory {
 public:
  using value_type = char;
  static constexpr std::ptrdiff_t most_kept = 16 << 20;  ///< larger memory goes back to CUDA's own pool [bytes]

  /// `peers`, or null: the GPUs that hold a piece each of what is larger than most_kept.
  StreamMemory(cudaStream_t stream, Peers* peers) : stream_(stream), peers_(peers) {}
  StreamMemory(const StreamMemory&) = delete;
  StreamMemory& operator=(const StreamMemory&) = delete;
  ~StreamMemory() { drop_kept(); }

  /// At least that many bytes, taken anew only where none of that size is kept. Throws NumericalError: none left.
  char* allocate(std::ptrdiff_t bytes);
  void deallocate(char* memory, std::ptrdiff_t bytes);  ///< keeps memory from allocate(bytes) for the next call

 private:
  /// Null where there is not enough.
  char* take(std::size_t bytes, bool keeps);
  void drop_kept();
  cudaStream_t stream_;
  Peers* peers_;
  std::mutex mutex_;
  std::multimap<std::size_t, char*> kept_;  ///< by the size that it was rounded up to [bytes]
};

/// The other side that a radix sort writes to by turns; grows with the largest sort.
struct SortSpace {
  explicit SortSpace(const GpuDevice& device) : keys(device), order(device), rest(device) {}
  Buffer<std::uint64_t, GpuDevice> keys;
  Buffer<int, GpuDevice> order;
  Buffer<char, GpuDevice> rest;
};

/// The memory that sorts and sums keep from call to call.
struct GpuScratch {
  explicit GpuScratch(const GpuDevice& device) : sort(device), sums(device), product(device, 1) {}
  SortSpace sort;
  SumSpace<GpuDevice> sums;
  Buffer<double, GpuDevice> product;
};

/// The page-locked host memory that few bytes pass through, on their way in and out: they come sooner by memory that
/// stays where it is. What goes in takes the next free bytes, all free again once the host has waited.
struct LockedMemory {
  static constexpr std::size_t few = 16384, size = 16 * few;  ///< [bytes]; the first few are for what comes out
  char* memory = nullptr;                                     ///< null where none was to be had
  std::size_t used = few;
};

/// The stream, scratch memory, events and profile of one GpuDevice.
struct GpuState {
  explicit GpuState(const std::vector<int>& gpus);
  GpuState(const GpuState&) = delete;
  GpuState& operator=(const GpuState&) = delete;
  ~GpuState();

  void select();  ///< makes this GPU the one that this thread's CUDA calls mean, and notes that it gets work
  void wait(const char* what);  ///< waits for the stream

  int index;
  cudaStream_t stream = nullptr;
  std::unique_ptr<Peers> peers;  ///< null for a device of one GPU
  bool starts_early = false, recording = false;
  bool is_idle = true;  ///< nothing was started on the stream since the host waited for it
  LockedMemory locked;
  std::multimap<std::size_t, void*> host_rooms;  ///< page-locked memory that nobody has, by its size [bytes]
  std::vector<cudaEvent_t> free_marks;           ///< events that nobody waits for
  Profile profile;
  std::unique_ptr<StreamMemory> memory;
  std::unique_ptr<GpuScratch> scratch;
};

}  // namespace talus
