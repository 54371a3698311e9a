// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sort, scan, gather and runs of equal keys on either device: oneTBB on the CPU, CUB and Thrust on the GPU; and how
// fast memory can be copied; sums and copies of vectors over the nodes. Pointers are into the memory of the device that
// is named with them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/parallel/for_each.hpp"

namespace talus {

/// This function leaves in order[] the stable permutation that sorts keys[], and keys[] sorted. Both have one size.
/// `bits`: the lowest ones, beyond which keys do not differ but for a key of ones alone.
void sort_order(const CpuDevice&, Buffer<std::uint64_t, CpuDevice>& keys, Buffer<int, CpuDevice>& order, int bits = 64);
/// On a GPU the sort is a radix sort, whose space the device keeps (see sort_space_bytes()).
void sort_order(const GpuDevice& device, Buffer<std::uint64_t, GpuDevice>& keys, Buffer<int, GpuDevice>& order,
                int bits = 64);

/// The memory that sorts on the device keep for the next one [bytes].
std::size_t sort_space_bytes(const CpuDevice&);
/// On a GPU that is the other side of the radix sort [bytes].
std::size_t sort_space_bytes(const GpuDevice& device);
/// This function frees the memory that sorts on the device keep.
void drop_sort_space(const CpuDevice&);
void drop_sort_space(const GpuDevice& device);

/// Writes sums[i] = values[0] + ... + values[i] for `count` values, and returns the total. Both may be one array.
/// Number is int or std::uint64_t.
template <class Number>
Number inclusive_sum(const CpuDevice&, const Number* values, Number* sums, int count);
/// On a GPU the call waits for the total.
template <class Number>
Number inclusive_sum(const GpuDevice& device, const Number* values, Number* sums, int count);

/// The sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(const CpuDevice&, const double* a, const double* b, int count);
/// On a GPU the order is fixed by `count` alone (sum_each()).
double inner_product(const GpuDevice& device, const double* a, const double* b, int count);

/// This function writes to[i] = from[order[i]] for `count` elements.
void gather(const CpuDevice&, const double* from, const int* order, double* to, int count);
void gather(const GpuDevice& device, const double* from, const int* order, double* to, int count);
/// This function writes to[order[i]] = from[i] for `count` elements; `order` names no place twice.
void scatter(const CpuDevice&, const double* from, const int* order, double* to, int count);
void scatter(const GpuDevice& device, const double* from, const int* order, double* to, int count);

/// The memory that can still be taken on a device [bytes].
double free_memory(const CpuDevice&);
double free_memory(const GpuDevice& device);

/// This function copies a few bytes out of a device's memory, once all that was started on it is done.
template <class Device>
void copy_to_host(const Device& device, void* host, const void* from, std::size_t bytes) {
  detail::download(device, host, from, bytes);
}
/// This function copies a few bytes into a device's memory; `host` may be written over when the call returns.
template <class Device>
void copy_from_host(const Device& device, void* to, const void* host, std::size_t bytes) {
  detail::upload(device, to, host, bytes);
}

namespace detail {
struct MarkRunStarts {
  const std::uint64_t* keys;
  int* marks;
  TALUS_HD void operator()(int i) const { marks[i] = i == 0 || keys[i] != keys[i - 1] ? 1 : 0; }
};
struct PlaceRunStarts {
  const std::uint64_t* keys;
  const int* runs;  ///< up to position i
  int count;
  int* starts;
  TALUS_HD void operator()(int i) const {
    if (i == 0 || keys[i] != keys[i - 1]) starts[runs[i] - 1] = i;
    if (i == count - 1) starts[runs[i]] = count;
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
  const int runs = inclusive_sum(device, scratch.data(), scratch.data(), count);
  starts.resize(static_cast<std::size_t>(runs) + 1);
  if (count == 0) starts.fill_zero();
  for_each(device, count, detail::PlaceRunStarts{keys.data(), scratch.data(), count, starts.data()});
  return runs;
}

/// The bytes read and written per second by a copy of a quarter of a gigabyte, the best of five [B/s].
double copy_bandwidth(const CpuDevice&);
/// On a GPU both copies are in its memory [B/s].
double copy_bandwidth(const GpuDevice& device);

/// A vector of three numbers for every node.
template <class Device>
using NodeVector = Buffer<Vec3<double>, Device>;

namespace detail {
struct Axpby {  // y = a x + b y
  double a, b;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int n) const { y[n] = x[n] * a + y[n] * b; }
};
struct Copy {
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int n) const { y[n] = x[n]; }
};
}  // namespace detail

/// This function sets y = a x + b y, of vectors of one size.
template <class Device>
void axpby(double a, const NodeVector<Device>& x, double b, NodeVector<Device>& y) {
  for_each(y.device(), static_cast<int>(y.size()), detail::Axpby{a, b, x.data(), y.data()});
}

/// This function copies x to y; y takes the size of x.
template <class Device>
void copy(const NodeVector<Device>& x, NodeVector<Device>& y) {
  y.resize(x.size());
  for_each(y.device(), static_cast<int>(x.size()), detail::Copy{x.data(), y.data()});
}

}  // namespace talus
