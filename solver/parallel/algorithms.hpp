// Sort and scan in either place: oneTBB on the CPU, CUB and Thrust on the GPU.
#pragma once

#include <array>
#include <cstdint>

#include "solver/parallel/device.hpp"

namespace talus {

/// order[] becomes the stable permutation that sorts keys[]; keys[] is left sorted. Sizes equal. `bits`: the lowest
/// ones, beyond which keys do not differ but for a key of ones alone.
void sort_order(CpuDevice, Buffer<std::uint64_t, CpuDevice>& keys, Buffer<int, CpuDevice>& order, int bits = 64);
void sort_order(GpuDevice, Buffer<std::uint64_t, GpuDevice>& keys, Buffer<int, GpuDevice>& order, int bits = 64);

/// What sorts keep for the next one [bytes].
std::size_t sort_space_bytes(CpuDevice);
std::size_t sort_space_bytes(GpuDevice);
void drop_sort_space(CpuDevice);
void drop_sort_space(GpuDevice);

/// sums[i] = values[0] + ... + values[i-1], for count values; returns the total. In place when both are the same.
int exclusive_sum(CpuDevice, const int* values, int* sums, int count);
int exclusive_sum(GpuDevice, const int* values, int* sums, int count);
/// The same for two lists of one length, each in its place; the device is waited for once.
std::array<int, 2> exclusive_sums(CpuDevice, int* first, int* second, int count);
std::array<int, 2> exclusive_sums(GpuDevice, int* first, int* second, int count);

/// Sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(CpuDevice, const double* a, const double* b, int count);
double inner_product(GpuDevice, const double* a, const double* b, int count);

/// to[i] = from[order[i]]
void gather(CpuDevice, const double* from, const int* order, double* to, int count);
void gather(GpuDevice, const double* from, const int* order, double* to, int count);
/// to[order[i]] = from[i]
void scatter(CpuDevice, const double* from, const int* order, double* to, int count);
void scatter(GpuDevice, const double* from, const int* order, double* to, int count);

/// Memory that can still be taken in a place [bytes].
double free_memory(CpuDevice);
double free_memory(GpuDevice);

/// A few bytes out of a place, and into it.
inline void copy_to_host(CpuDevice, void* host, const void* from, std::size_t bytes) { std::memcpy(host, from, bytes); }
inline void copy_to_host(GpuDevice, void* host, const void* from, std::size_t bytes) {
  detail::gpu_download(host, from, bytes);
}
inline void copy_from_host(CpuDevice, void* to, const void* host, std::size_t bytes) { std::memcpy(to, host, bytes); }
inline void copy_from_host(GpuDevice, void* to, const void* host, std::size_t bytes) {
  detail::gpu_upload(to, host, bytes);
}

}  // namespace talus
