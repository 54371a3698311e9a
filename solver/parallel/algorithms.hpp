// Sort and scan in either place: oneTBB on the CPU, Thrust on the GPU.
#pragma once

#include <cstdint>

#include "solver/parallel/place.hpp"

namespace talus {

/// order[] becomes the stable permutation that sorts keys[]; keys[] is left sorted. Sizes equal.
void sort_order(OnCpu, Buffer<std::uint64_t, OnCpu>& keys, Buffer<int, OnCpu>& order);
void sort_order(OnGpu, Buffer<std::uint64_t, OnGpu>& keys, Buffer<int, OnGpu>& order);

/// sums[i] = values[0] + ... + values[i-1], for count values; returns the total. In place when both are the same.
int exclusive_sum(OnCpu, const int* values, int* sums, int count);
int exclusive_sum(OnGpu, const int* values, int* sums, int count);

/// Sum of count doubles, in a fixed order on the CPU.
double sum(OnCpu, const double* values, int count);
double sum(OnGpu, const double* values, int count);

/// Sum of a[i] * b[i], in a fixed order on the CPU whatever the number of threads.
double inner_product(OnCpu, const double* a, const double* b, int count);
double inner_product(OnGpu, const double* a, const double* b, int count);

/// Largest |a[i]|; 0 for none.
double largest_entry(OnCpu, const double* a, int count);
double largest_entry(OnGpu, const double* a, int count);

}  // namespace talus
