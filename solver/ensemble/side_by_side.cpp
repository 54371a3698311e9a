// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/side_by_side.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"
#include "solver/parallel/alone.hpp"

namespace talus::solver {

void side_by_side(std::size_t count, const std::vector<AnyDevice>& devices,
                  const std::function<void(std::size_t place, const AnyDevice& device)>& run) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&, &here = context()](const AnyDevice& device) {
    const BindContext bind(here);
    const Alone alone;
    try {
      for (;;) {
        if (interrupted() || failed) return;
        const std::size_t place = next++;
        if (place >= count) return;
        run(place, device);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> one(mutex);
      failed = true;
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (const AnyDevice& device : devices) threads.emplace_back(work, std::cref(device));
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace talus::solver
