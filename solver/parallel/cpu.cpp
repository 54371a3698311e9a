// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "common/large_memory.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/parallel/pace.hpp"

namespace talus {

std::string hardware_of(const AnyDevice& device) { return device.is_gpu() ? device.gpu().name() : hardware(); }

CpuDevice CpuDevice::make() { return CpuDevice(std::make_shared<Profile>()); }

namespace detail {

void* allocate(const CpuDevice&, std::size_t bytes) {
  void* memory = memory_in_large_pages(bytes);
  if (!memory) throw std::bad_alloc();
  return memory;
}
void free(const CpuDevice&, void* memory, std::size_t) noexcept { std::free(memory); }
void* lend_host(const CpuDevice& device, std::size_t bytes) { return allocate(device, bytes); }
void give_back_host(const CpuDevice& device, void* memory, std::size_t bytes) noexcept { free(device, memory, bytes); }
void upload(const CpuDevice&, void* to, const void* host, std::size_t bytes) { std::memcpy(to, host, bytes); }
void download(const CpuDevice&, void* host, const void* from, std::size_t bytes) { std::memcpy(host, from, bytes); }
void fill_zero(const CpuDevice&, void* memory, std::size_t bytes) { std::memset(memory, 0, bytes); }

namespace {

/// Some pieces of a loop.
struct Pieces {
  const LoopOrder* order;
  void (*body)(const void*, int, int);
  const void* kernel;

  TALUS_HANDED_OVER void operator()(const tbb::blocked_range<int>& range) const {
    order->begin_piece();
    body(kernel, range.begin(), range.end());
    order->end_piece();
  }
};

}  // namespace

void cpu_parallel(int count, int grain, void (*body)(const void*, int, int), const void* kernel) {
  if (count <= 0) return;
  if (count <= grain) {
    body(kernel, 0, count);
    return;
  }
  paced(
      reinterpret_cast<const void*>(body), count, [=] { body(kernel, 0, count); },
      [=] {
        const LoopOrder order;
        tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                          Pieces{&order, body, kernel});
      });
}

}  // namespace detail

namespace {

constexpr int leaf = 4096;  // products that are added up one after the other

/// Halves a range as oneTBB's simple_partitioner does, so that the sum has the same bits on one thread as on many.
double sum_of_products(const double* a, const double* b, int begin, int end) {
  if (end - begin > leaf) {
    const int middle = begin + (end - begin) / 2;
    return sum_of_products(a, b, begin, middle) + sum_of_products(a, b, middle, end);
  }
  double total = 0;
  for (int i = begin; i < end; ++i) total += a[i] * b[i];
  return total;
}

/// Adds some of the products to a sum.
struct Products {
  const detail::LoopOrder* order;
  const double *a, *b;

  TALUS_HANDED_OVER double operator()(const tbb::blocked_range<int>& range, double total) const {
    order->begin_piece();
    total += sum_of_products(a, b, range.begin(), range.end());
    order->end_piece();
    return total;
  }
};

}  // namespace

void sort_order(const CpuDevice&, Buffer<std::uint64_t, CpuDevice>& keys, Buffer<int, CpuDevice>& order, int) {
  const int count = static_cast<int>(keys.size());
  order.resize(keys.size());
  std::vector<std::pair<std::uint64_t, int>> pairs(keys.size());
  for (int i = 0; i < count; ++i) pairs[static_cast<std::size_t>(i)] = {keys.data()[i], i};
  // The index makes every pair distinct, so the order is that of a stable sort, whoever sorts.
  const auto alone = [&] { std::sort(pairs.begin(), pairs.end()); };
  if constexpr (detail::under_thread_sanitizer) {
    alone();
  } else {
    static const char kind = 0;
    detail::paced(&kind, count, alone, [&] { tbb::parallel_sort(pairs); });
  }
  for (int i = 0; i < count; ++i) {
    keys.data()[i] = pairs[static_cast<std::size_t>(i)].first;
    order.data()[i] = pairs[static_cast<std::size_t>(i)].second;
  }
}

template <class Number>
Number inclusive_sum(const CpuDevice&, const Number* values, Number* sums, int count) {
  Number total = 0;
  for (int i = 0; i < count; ++i) sums[i] = total += values[i];
  return total;
}
template int inclusive_sum(const CpuDevice&, const int*, int*, int);
template std::uint64_t inclusive_sum(const CpuDevice&, const std::uint64_t*, std::uint64_t*, int);

std::size_t sort_space_bytes(const CpuDevice&) { return 0; }
void drop_sort_space(const CpuDevice&) {}

double inner_product(const CpuDevice&, const double* a, const double* b, int count) {
  const auto alone = [=] { return sum_of_products(a, b, 0, count); };
  if (count <= leaf) return alone();
  static const char kind = 0;
  return detail::paced(&kind, count, alone, [=] {
    const detail::LoopOrder order;
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<int>(0, count, leaf), 0.0, Products{&order, a, b}, [](double x, double y) { return x + y; },
        tbb::simple_partitioner());
  });
}

void gather(const CpuDevice&, const double* from, const int* order, double* to, int count) {
  for (int i = 0; i < count; ++i) to[i] = from[order[i]];
}

void scatter(const CpuDevice&, const double* from, const int* order, double* to, int count) {
  for (int i = 0; i < count; ++i) to[order[i]] = from[i];
}

double free_memory(const CpuDevice&) { return memory_of_machine("MemAvailable"); }

}  // namespace talus
