// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/large_memory.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {
constexpr std::size_t line = 64, page = std::size_t{2} << 20, large = 4 * page;
}

void* talus::memory_in_large_pages(std::size_t bytes) noexcept {
  const std::size_t unit = bytes >= large ? page : line, whole = (bytes + unit - 1) / unit * unit;
  void* const memory = std::aligned_alloc(unit, whole);
  if (memory != nullptr && unit == page) static_cast<void>(madvise(memory, whole, MADV_HUGEPAGE));
  return memory;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which have their own

void* operator new(std::size_t size) {
  for (;;) {
    void* const memory = size >= large ? talus::memory_in_large_pages(size) : std::malloc(size > 0 ? size : 1);
    if (memory != nullptr) return memory;
    if (const std::new_handler handler = std::get_new_handler()) {
      handler();
    } else {
      throw std::bad_alloc();
    }
  }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#endif
