// Sort and scan in either place: oneTBB on the CPU, CUB and Thrust on the GPU.
#pragma once

#include <array>
#include <cstdint>

#include "solver/parallel/place.hpp"

namespace talus {

/// order[] becomes the stable permutation that sorts keys[]; keys[] is left sorted. Sizes equal. `bits`: the lowest
/// ones, beyond which keys do not differ but for a key of ones alone.
void sort_order(OnCpu, Buffer<std::uint64_t, OnCpu>& keys, Buffer<int, OnCpu>& order, int bits = 64);
void sort_order(OnGpu, Buffer<std::uint64_t, OnGpu>& keys, Buffer<int, OnGpu>& order, int bits = 64);

/// What sorts keep for the next one [bytes].
std::size_t sort_space_bytes(OnCpu);
std::size_t sort_space_bytes(OnGpu);
void drop_sort_space(OnCpu);
void drop_sort_space(OnGpu);

/// sums[i] = values[0] + ... + values[i-1], for count values; returns the total. In place when both are the same.
int exclusive_sum(OnCpu, const int* values, int* sums, int count);
int exclusive_sum(OnGpu, const int* values, int* sums, int count);
/// The same for two lists of one length, each in its place; the device is waited for once.
std::array<int, 2> exclusive_sums(OnCpu, int* first, int* second, int count);
std::array<int, 2> exclusive_sums(OnGpu, int* first, int* second, int count);

/// Sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(OnCpu, const double* a, const double* b, int count);
double inner_product(OnGpu, const double* a, const double* b, int count);

/// to[i] = from[order[i]]
void gather(OnCpu, const double* from, const int* order, double* to, int count);
void gather(OnGpu, const double* from, const int* order, double* to, int count);
/// to[order[i]] = from[i]
void scatter(OnCpu, const double* from, const int* order, double* to, int count);
void scatter(OnGpu, const double* from, const int* order, double* to, int count);

/// Memory that can still be taken in a place [bytes].
double free_memory(OnCpu);
double free_memory(OnGpu);

/// A few bytes out of a place, and into it.
inline void copy_to_host(OnCpu, void* host, const void* from, std::size_t bytes) { std::memcpy(host, from, bytes); }
inline void copy_to_host(OnGpu, void* host, const void* from, std::size_t bytes) {
  detail::gpu_download(host, from, bytes);
}
inline void copy_from_host(OnCpu, void* to, const void* host, std::size_t bytes) { std::memcpy(to, host, bytes); }
inline void copy_from_host(OnGpu, void* to, const void* host, std::size_t bytes) {
  detail::gpu_upload(to, host, bytes);
}

}  // namespace talus
