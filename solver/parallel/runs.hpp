// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of equal keys in a sorted array: what a reduction by key works on.
#pragma once

#include <cstdint>

#include "solver/parallel/algorithms.hpp"

namespace talus {

namespace detail {
struct MarkRunStarts {
  const std::uint64_t* keys;
  int* marks;
  TALUS_HD void operator()(int i) const { marks[i] = i == 0 || keys[i] != keys[i - 1] ? 1 : 0; }
};
struct PlaceRunStarts {
  const std::uint64_t* keys;
  const int* places;  ///< runs before position i
  int count, runs;
  int* starts;
  TALUS_HD void operator()(int i) const {
    if (i == 0 || keys[i] != keys[i - 1]) starts[places[i]] = i;
    if (i == count - 1) starts[runs] = count;
  }
};
}  // namespace detail

/// This function finds the runs of equal keys: starts[r] becomes the first position of run r, starts[runs] the number
/// of keys. It returns the number of runs.
template <class Device>
int find_runs(const Buffer<std::uint64_t, Device>& keys, Buffer<int, Device>& starts, Buffer<int, Device>& scratch) {
  const Device& device = keys.device();
  const int count = static_cast<int>(keys.size());
  scratch.resize(keys.size());
  for_each(device, count, detail::MarkRunStarts{keys.data(), scratch.data()});
  const int runs = exclusive_sum(device, scratch.data(), scratch.data(), count);
  starts.resize(static_cast<std::size_t>(runs) + 1);
  if (count == 0) starts.fill_zero();
  for_each(device, count, detail::PlaceRunStarts{keys.data(), scratch.data(), count, runs, starts.data()});
  return runs;
}

}  // namespace talus
