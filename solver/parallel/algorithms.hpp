// Sort, scan and gather on either device: oneTBB on the CPU, CUB and Thrust on the GPU. Pointers are into the memory of
// the device that is named with them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "solver/parallel/for_each.hpp"

namespace talus {

/// order[] becomes the stable permutation that sorts keys[]; keys[] is left sorted. Sizes equal. `bits`: the lowest
/// ones, beyond which keys do not differ but for a key of ones alone.
void sort_order(const CpuDevice&, Buffer<std::uint64_t, CpuDevice>& keys, Buffer<int, CpuDevice>& order, int bits = 64);
void sort_order(const GpuDevice& device, Buffer<std::uint64_t, GpuDevice>& keys, Buffer<int, GpuDevice>& order,
                int bits = 64);

/// Memory that sorts on the device keep for the next one [bytes].
std::size_t sort_space_bytes(const CpuDevice&);
std::size_t sort_space_bytes(const GpuDevice& device);
/// Frees the memory that sorts on the device keep.
void drop_sort_space(const CpuDevice&);
void drop_sort_space(const GpuDevice& device);

/// sums[i] = values[0] + ... + values[i-1], for count values; returns the total. In place when both are the same.
int exclusive_sum(const CpuDevice&, const int* values, int* sums, int count);
int exclusive_sum(const GpuDevice& device, const int* values, int* sums, int count);
/// The exclusive sums of two lists of one length, each in its place, and their totals; the device is waited for once.
std::array<int, 2> exclusive_sums(const CpuDevice& device, int* first, int* second, int count);
std::array<int, 2> exclusive_sums(const GpuDevice& device, int* first, int* second, int count);

/// Sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(const CpuDevice&, const double* a, const double* b, int count);
double inner_product(const GpuDevice& device, const double* a, const double* b, int count);

/// to[i] = from[order[i]]
void gather(const CpuDevice&, const double* from, const int* order, double* to, int count);
void gather(const GpuDevice& device, const double* from, const int* order, double* to, int count);
/// to[order[i]] = from[i]
void scatter(const CpuDevice&, const double* from, const int* order, double* to, int count);
void scatter(const GpuDevice& device, const double* from, const int* order, double* to, int count);

/// Memory that can still be taken on a device [bytes].
double free_memory(const CpuDevice&);
double free_memory(const GpuDevice& device);

/// Copies a few bytes out of a device's memory, once all that was started on it is done.
template <class Device>
void copy_to_host(const Device& device, void* host, const void* from, std::size_t bytes) {
  detail::download(device, host, from, bytes);
}
/// Copies a few bytes into a device's memory; `host` may be written over when the call returns.
template <class Device>
void copy_from_host(const Device& device, void* to, const void* host, std::size_t bytes) {
  detail::upload(device, to, host, bytes);
}

}  // namespace talus
