// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The GPUs of one host that work as one device. For the CUDA files of this folder alone.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace talus {

/// Several GPUs that share large kernels, block by block, and the memory of large buffers, piece by piece. Every GPU
/// reads and writes the memory of all, so that kernels know of one only. A GPU may be named twice: its parts work as
/// two GPUs would.
class Peers {
 public:
  /// `gpus`: indices of CUDA, two at least; the first one's stream is `first`, on which all else runs. Throws
  /// RecipeError where two of them cannot read one another's memory.
  Peers(const std::vector<int>& gpus, cudaStream_t first);
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;
  ~Peers();

  std::int64_t share_from;                                       ///< threads of a kernel that is shared, at least
  int count() const { return static_cast<int>(parts_.size()); }  ///< number of GPUs
  /// Lets all streams wait for what was started on the first.
  void fork();
  /// Makes GPU n the one that this thread's CUDA calls mean, 0 <= n < count(), and returns its stream.
  cudaStream_t select(int n) const;
  /// Lets the first stream wait for all others, and makes its GPU the selected one again.
  void join();

  /// Memory of which every GPU holds a piece of the same size, in their order. Null where there is not enough.
  char* allocate(std::size_t bytes);
  /// Frees it, once all that was started is done.
  void free(char* memory);

 private:
  struct Part {
    int gpu;
    cudaStream_t stream;
    cudaEvent_t done;  ///< of the first one: what was started before a fork
  };
  std::vector<Part> parts_;
  std::map<char*, std::size_t> sizes_;  ///< of what was allocated [bytes]
};

}  // namespace talus
