// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sort, scan and gather on either device: oneTBB on the CPU, CUB and Thrust on the GPU. Pointers are into the memory of
// the device that is named with them.
#pragma once

#include <array>
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
/// On a GPU the next sort takes that memory anew.
void drop_sort_space(const GpuDevice& device);

/// This function writes sums[i] = values[0] + ... + values[i-1] for `count` values, and returns the total. Both may be
/// one array.
int exclusive_sum(const CpuDevice&, const int* values, int* sums, int count);
/// On a GPU the call waits for the total.
int exclusive_sum(const GpuDevice& device, const int* values, int* sums, int count);
/// This function replaces two lists of one length by their exclusive sums, and returns their totals; the device is
/// waited for once.
std::array<int, 2> exclusive_sums(const CpuDevice& device, int* first, int* second, int count);
/// On a GPU both totals come to the host in one copy.
std::array<int, 2> exclusive_sums(const GpuDevice& device, int* first, int* second, int count);

/// The sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(const CpuDevice&, const double* a, const double* b, int count);
/// On a GPU the order is fixed by `count` alone (sum_each()).
double inner_product(const GpuDevice& device, const double* a, const double* b, int count);

/// This function writes to[i] = from[order[i]] for `count` elements.
void gather(const CpuDevice&, const double* from, const int* order, double* to, int count);
/// On a GPU the gather is one kernel.
void gather(const GpuDevice& device, const double* from, const int* order, double* to, int count);
/// This function writes to[order[i]] = from[i] for `count` elements; `order` names no place twice.
void scatter(const CpuDevice&, const double* from, const int* order, double* to, int count);
/// On a GPU the scatter is one kernel.
void scatter(const GpuDevice& device, const double* from, const int* order, double* to, int count);

/// The memory that can still be taken on a device [bytes].
double free_memory(const CpuDevice&);
/// On a GPU that is what CUDA reports as free [bytes].
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

}  // namespace talus
