#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <new>

#include "solver/parallel/device.hpp"

namespace talus::detail {

void* cpu_allocate(std::size_t bytes) {
  constexpr std::size_t line = 64;
  void* memory = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (!memory) throw std::bad_alloc();
  return memory;
}

void cpu_free(void* memory) { std::free(memory); }

void cpu_parallel(int count, int grain, void (*body)(const void*, int, int), const void* kernel) {
  if (count <= 0) return;
  if (count <= grain) {
    body(kernel, 0, count);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                    [=](const tbb::blocked_range<int>& range) { body(kernel, range.begin(), range.end()); });
}

}  // namespace talus::detail
