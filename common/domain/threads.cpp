// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/threads.hpp"

#include <dlfcn.h>
#include <tbb/global_control.h>

#include <algorithm>

namespace talus {
namespace {

/// Calls `void name(int)` of a library, where one that has it is loaded: the solver reaches OpenMP and OpenBLAS through
/// CHOLMOD alone, and in programs without them there is nothing to limit.
void call_if_loaded(const char* name, int value) {
  if (void* found = dlsym(RTLD_DEFAULT, name)) reinterpret_cast<void (*)(int)>(found)(value);
}

std::shared_ptr<void> limit_onetbb(int threads) {
  return std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               static_cast<std::size_t>(std::max(1, threads)));
}

}  // namespace

void limit_threads_of_libraries(int threads) {
  static std::shared_ptr<void> limit;
  limit.reset();
  limit = limit_onetbb(threads);
  call_if_loaded("omp_set_num_threads", threads);
  call_if_loaded("openblas_set_num_threads", threads);
}

ThreadsOfLibraries::ThreadsOfLibraries(int threads) : limit_(limit_onetbb(threads)) {}

}  // namespace talus
