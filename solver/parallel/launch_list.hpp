// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels that a run would start one after the other, kept so that they can be started with those of other runs.
#pragma once

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

struct CUstream_st;  // CUDA's

namespace talus {

/// The end of the blocks of a run that is not there.
inline constexpr int no_block = std::numeric_limits<int>::max();

/// The kernels of several runs of one type, one of each, in the memory of the GPU. Their blocks follow one another.
struct LaunchTable {
  static constexpr int most = 32;  ///< runs; a warp looks for a block's run
  const int* ends;                 ///< [most] the first block after those of a run; without a run the largest number
  const void* kernels;             ///< [most]
};

/// How a kernel is laid out on a GPU.
struct LaunchShape {
  CUstream_st* stream;
  int blocks, threads;
  bool early;  ///< it may come onto the GPU while the one before it is ending
};

/// This function starts the kernels of a table, all of one type, as one; there may be more blocks than they have.
using StartSeveral = void (*)(const LaunchShape& shape, const LaunchTable& table);

/// A list of kernels with what they need to be started, in their order.
class LaunchList {
 public:
  /// A kernel of the list.
  struct Launch {
    StartSeveral start;
    int blocks, threads;
    std::size_t place, bytes;  ///< of what it is
  };

  /// The method empties the list.
  void clear() {
    launches_.clear();
    bytes_.clear();
    alone_ = nullptr;
  }
  /// The method adds a kernel; `start` starts those of its type.
  template <class Kernel>
  void add(const Kernel& kernel, int blocks, int threads, StartSeveral start) {
    static_assert(std::is_trivially_copyable_v<Kernel>, "a kernel is pointers and numbers");
    launches_.push_back({start, blocks, threads, bytes_.size(), sizeof kernel});
    const auto* const first = reinterpret_cast<const std::byte*>(&kernel);
    bytes_.insert(bytes_.end(), first, first + sizeof kernel);
  }
  /// The method notes a kernel that cannot be started with those of other runs, by `where` it was to be started.
  void leave_out(const char* where) { alone_ = where; }

  /// Where the last kernel that was left out was to be started; null where the list holds all.
  const char* left_out() const { return alone_; }
  /// The kernels, in their order.
  const std::vector<Launch>& launches() const { return launches_; }
  /// The bytes of kernel number k, launches()[k].bytes of them.
  const std::byte* kernel(std::size_t k) const { return bytes_.data() + launches_[k].place; }
  /// Whether another list has the same kinds of kernels in the same order.
  bool is_alike(const LaunchList& other) const {
    if (launches_.size() != other.launches_.size()) return false;
    for (std::size_t k = 0; k < launches_.size(); ++k) {
      const Launch &a = launches_[k], &b = other.launches_[k];
      if (a.start != b.start || a.threads != b.threads) return false;
    }
    return true;
  }

 private:
  std::vector<Launch> launches_;
  std::vector<std::byte> bytes_;
  const char* alone_ = nullptr;
};

/// The work of a run that is started with that of others: `step` again and again, between `begin` and `end`.
struct SharedWork {
  LaunchList begin, step, end;
  /// Throws std::logic_error: a kernel of it cannot be started with those of others.
  void check() const {
    for (const LaunchList* list : {&begin, &step, &end})
      if (const char* const where = list->left_out())
        throw std::logic_error("started alone, in a run that says that it starts with others: " + std::string(where));
  }
  /// Whether other work has the same kinds of kernels in the same order.
  bool is_alike(const SharedWork& other) const {
    return begin.is_alike(other.begin) && step.is_alike(other.step) && end.is_alike(other.end);
  }
};

}  // namespace talus
