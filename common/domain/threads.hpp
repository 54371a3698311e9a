// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many threads libraries may take.
#pragma once

#include <memory>

namespace talus {

/// From now on oneTBB (which OpenVDB and the solver's loops run on), OpenMP and OpenBLAS, where they are loaded, take
/// at most so many threads, the calling one included. To be called before their first work; 1: they start none.
void limit_threads_of_libraries(int threads);

/// While it lives oneTBB takes at most so many threads, the calling one included. For work that is shared among threads
/// already: what each of them calls need wake no others.
class ThreadsOfLibraries {
 public:
  explicit ThreadsOfLibraries(int threads);

 private:
  std::shared_ptr<void> limit_;
};

}  // namespace talus
