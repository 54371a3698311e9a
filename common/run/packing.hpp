// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Chunks of HDF5 files, packed as its filters pack them (shuffled and deflated), on all threads.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace talus::h5 {

inline constexpr int effort = 1;  ///< of libdeflate: 4 takes twice as long for 2 % less

/// A chunk as HDF5's filters store it: all first bytes of its values, all second ones, ..., deflated. What `values`
/// lack of `bytes` are zeros.
std::string packed(std::span<const char> values, std::size_t bytes, std::size_t width);

/// Takes a chunk apart: the bytes from `skip` on of what packed() was given. Returns false where it is damaged.
bool unpacked(std::span<const char> stored, std::size_t bytes, std::size_t width, std::size_t skip,
              std::span<char> values);

/// A chunk of a dataset that is being packed.
struct PackingChunk {
  std::string path;  ///< of the dataset
  hid_t set;
  std::vector<hsize_t> offset;  ///< of its first value in the dataset
  std::string values;
  std::size_t bytes, width;  ///< of a whole chunk, and of a value
  std::string stored = {};
};

/// Chunks that are packed while their writer goes on, and written in the order in which they came.
class PackingQueue {
 public:
  PackingQueue() = default;
  PackingQueue(const PackingQueue&) = delete;
  PackingQueue& operator=(const PackingQueue&) = delete;
  ~PackingQueue();

  void add(PackingChunk chunk);
  /// The method calls write(chunk) for those at the front that are packed, or, where so many wait that memory counts or
  /// `all` are asked for, for all of them, once they are. It throws what packing or `write` threw.
  void write(bool all, const std::function<void(const PackingChunk&)>& write);

 private:
  struct Entry {
    PackingChunk chunk;
    std::atomic<bool> done = false;
  };
  void wait();

  std::deque<Entry> entries_;
  tbb::task_arena arena_;  ///< threads that add chunks come and go
  tbb::task_group packing_;
};

}  // namespace talus::h5
