// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a GpuDevice owns. For the CUDA files of this folder alone.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "solver/parallel/sums.hpp"

namespace talus {

/// Throws where the call of CUDA `what` failed: NumericalError where memory was short, std::runtime_error otherwise.
void check_cuda(cudaError_t code, const char* what);

/// The memory that Thrust borrows, kept for its next call: to allocate device memory is to wait for the device.
class BorrowedMemory {
 public:
  using value_type = char;
  explicit BorrowedMemory(GpuDevice device) : device_(std::move(device)) {}
  BorrowedMemory(const BorrowedMemory&) = delete;
  BorrowedMemory& operator=(const BorrowedMemory&) = delete;
  ~BorrowedMemory();

  /// At least that many bytes of device memory, taken anew only where none is free. Throws NumericalError: none left.
  char* allocate(std::ptrdiff_t bytes);
  void deallocate(char* memory, std::size_t bytes);  ///< keeps memory from allocate() for the next call

 private:
  GpuDevice device_;
  std::multimap<std::ptrdiff_t, char*> free_;
  std::map<char*, std::ptrdiff_t> taken_;
};

/// The other side that a radix sort writes to by turns; grows with the largest sort.
struct SortSpace {
  explicit SortSpace(const GpuDevice& device) : keys(device), order(device), rest(device) {}
  Buffer<std::uint64_t, GpuDevice> keys;
  Buffer<int, GpuDevice> order;
  Buffer<char, GpuDevice> rest;
};

/// The memory that sorts, scans and sums keep from call to call.
struct GpuScratch {
  explicit GpuScratch(const GpuDevice& device)
      : borrowed(device), sort(device), totals(device, 2), sums(device), product(device, 1) {}
  BorrowedMemory borrowed;
  SortSpace sort;
  Buffer<int, GpuDevice> totals;
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
  explicit GpuState(int gpu);
  GpuState(const GpuState&) = delete;
  GpuState& operator=(const GpuState&) = delete;
  ~GpuState();

  void select();  ///< makes this GPU the one that this thread's CUDA calls mean, and notes that it gets work
  void wait(const char* what);  ///< waits for the stream

  int index;
  cudaStream_t stream = nullptr;
  bool starts_early = false, recording = false;
  bool is_idle = true;  ///< nothing was started on the stream since the host waited for it
  LockedMemory locked;
  std::multimap<std::size_t, void*> host_rooms;  ///< page-locked memory that nobody has, by its size [bytes]
  std::vector<cudaEvent_t> free_marks;           ///< events that nobody waits for
  Profile profile;
  std::unique_ptr<GpuScratch> scratch;
};

}  // namespace talus
