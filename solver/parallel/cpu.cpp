// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <cstring>
#include <new>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/parallel/loop_order.hpp"
#include "solver/parallel/pace.hpp"

namespace talus {

CpuDevice CpuDevice::make() { return CpuDevice(std::make_shared<Profile>()); }

namespace detail {

void* allocate(const CpuDevice&, std::size_t bytes) {
  constexpr std::size_t line = 64;
  void* memory = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (!memory) throw std::bad_alloc();
  return memory;
}
void free(const CpuDevice&, void* memory) noexcept { std::free(memory); }
void* lend_host(const CpuDevice& device, std::size_t bytes) { return allocate(device, bytes); }
void give_back_host(const CpuDevice& device, void* memory, std::size_t) noexcept { free(device, memory); }
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
}  // namespace talus
