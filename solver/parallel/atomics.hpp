// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Atomic updates of one memory location from many threads, on either device. On GPUs they are those of the system: a
// kernel may run on several at a time, and on one they take as long as its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>

#include "solver/parallel/math.hpp"

namespace talus {

/// This function keeps the largest of the values seen, for floats >= 0: their bit patterns order as the numbers do. The
/// lanes of a warp that meet here name the same location: one of them updates it for all, for atomics at one address
/// come one after the other.
TALUS_HD void atomic_max_positive(std::uint32_t* bits, float value) {
#if defined(__CUDA_ARCH__)
  const unsigned together = __activemask(), most = __reduce_max_sync(together, __float_as_uint(value));
  const bool speaks = static_cast<int>(threadIdx.x % 32) == __ffs(static_cast<int>(together)) - 1;
  if (speaks && most > *bits) atomicMax_system(bits, most);  // the read spares nearly all atomics
#else
  std::uint32_t mine;
  std::memcpy(&mine, &value, sizeof mine);
  std::atomic_ref<std::uint32_t> target(*bits);
  std::uint32_t seen = target.load(std::memory_order_relaxed);
  while (mine > seen && !target.compare_exchange_weak(seen, mine, std::memory_order_relaxed)) {
  }
#endif
}

/// The float >= 0 whose bit pattern atomic_max_positive() has kept.
TALUS_HD float positive_from_bits(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(bits);
#else
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
#endif
}

/// This function lowers *target to `value` where that is less.
TALUS_HD void atomic_min(int* target, int value) {
#if defined(__CUDA_ARCH__)
  if (value < *target) atomicMin_system(target, value);
#else
  std::atomic_ref<int> a(*target);
  int seen = a.load(std::memory_order_relaxed);
  while (value < seen && !a.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
#endif
}

/// This function raises *target to `value` where that is more.
TALUS_HD void atomic_max(int* target, int value) {
#if defined(__CUDA_ARCH__)
  if (value > *target) atomicMax_system(target, value);
#else
  std::atomic_ref<int> a(*target);
  int seen = a.load(std::memory_order_relaxed);
  while (value > seen && !a.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
#endif
}

/// Adds to one double from many threads. Lanes of a warp that meet here name one target, as in atomic_max_positive().
TALUS_HD void atomic_add(double* target, double value) {
#if defined(__CUDA_ARCH__)
  const unsigned together = __activemask();
  if (together == 0xffffffffu) {
    for (unsigned apart = 16; apart > 0; apart /= 2) value += __shfl_down_sync(together, value, apart);
    if (threadIdx.x % 32 == 0) atomicAdd_system(target, value);
  } else {
    atomicAdd_system(target, value);
  }
#else
  std::atomic_ref<double> a(*target);
  a.fetch_add(value, std::memory_order_relaxed);
#endif
}

/// This function adds 1 to *target.
TALUS_HD void atomic_increment(int* target) {
#if defined(__CUDA_ARCH__)
  atomicAdd_system(target, 1);
#else
  std::atomic_ref<int>(*target).fetch_add(1, std::memory_order_relaxed);
#endif
}

/// This function adds to a whole number from many threads.
TALUS_HD void add_to_bin(unsigned long long* target, unsigned long long value) {
#if defined(__CUDA_ARCH__)
  atomicAdd_system(target, value);
#else
  std::atomic_ref<unsigned long long>(*target).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// This function stores `value` where `expected` is found, and nowhere else.
TALUS_HD void replace_if(int* target, int expected, int value) {
#if defined(__CUDA_ARCH__)
  atomicCAS_system(target, expected, value);
#else
  std::atomic_ref<int>(*target).compare_exchange_strong(expected, value, std::memory_order_relaxed);
#endif
}

/// This function stores a flag that several threads may set to the same meaning.
TALUS_HD void raise_flag(int* flag, int value) {
#if defined(__CUDA_ARCH__)
  atomicExch_system(flag, value);
#else
  std::atomic_ref<int>(*flag).store(value, std::memory_order_relaxed);
#endif
}

/// Adds to a grid node while points are scattered. On the CPU the scatter runs by colours of column blocks that share
/// no node (for_each_grouped), so a plain sum is enough and its order is always the same; on the GPU the sum is atomic.
template <class Real>
TALUS_HD void scatter_add(Real* target, Real value) {
#if defined(__CUDA_ARCH__)
  atomicAdd_system(target, value);
#else
  *target += value;
#endif
}

/// This function adds to the three components of a node's vector, in the same way.
template <class Real>
TALUS_HD void scatter_add(Vec3<Real>* target, const Vec3<Real>& v) {
  scatter_add(&target->x, v.x);
  scatter_add(&target->y, v.y);
  scatter_add(&target->z, v.z);
}

/// This function adds to a node's mass and momentum at once, in the same way.
template <class Real>
TALUS_HD void scatter_add(Vec4<Real>* target, const Four<Real>& v) {
#if defined(__CUDA_ARCH__)
  const Vec3<Real> xyz = v.xyz();
#if __CUDA_ARCH__ >= 900
  if constexpr (sizeof(Real) == 4) {  // one 16-byte atomic instead of four
    asm volatile("red.relaxed.sys.global.add.v4.f32 [%0], {%1, %2, %3, %4};" ::"l"(target), "f"(v.w()), "f"(xyz.x),
                 "f"(xyz.y), "f"(xyz.z)
                 : "memory");
    return;
  }
#endif
  scatter_add(&target->w, v.w());
  scatter_add(&target->x, xyz.x);
  scatter_add(&target->y, xyz.y);
  scatter_add(&target->z, xyz.z);
#else
  Four<Real> sum(*target);
  sum += v;
  sum.store(*target);
#endif
}

/// This function brings a value near to a GPU's multiprocessor, ahead of its use.
template <class T>
TALUS_HD void prefetch([[maybe_unused]] const T* value) {
#if defined(__CUDA_ARCH__)
  asm volatile("prefetch.global.L1 [%0];" ::"l"(value));
#endif
}

}  // namespace talus
