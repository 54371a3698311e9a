// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/in_threads.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "common/stage/context.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

/// The pieces of work while threads take them.
class Shared {
 public:
  Shared(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work), place_of_failure_(count) {}

  void take_all() {
    while (!interrupted() && !failed_) {
      const std::size_t place = next_++;
      if (place >= count_) return;
      try {
        work_(place);
        ++done_;
      } catch (...) {
        note_failure(place);
      }
    }
  }
  bool all_done() const { return done_ == count_; }
  std::exception_ptr failure() const { return failure_; }

 private:
  void note_failure(std::size_t place) {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    if (place >= place_of_failure_) return;
    place_of_failure_ = place;
    failure_ = std::current_exception();
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_{0}, done_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t place_of_failure_;
};

}  // namespace

void in_threads(std::size_t count, const std::string& doing, const std::function<void(std::size_t place)>& work,
                std::size_t most) {
  const std::size_t wanted = std::min({count, most, static_cast<std::size_t>(std::max(1, thread_limit()))});
  Shared shared(count, work);
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < wanted)
        others.emplace_back([&, &here = context()] {
          const BindContext bind(here);
          shared.take_all();
        });
    } catch (const std::system_error&) {  // the system gives no more threads: those that there are do the work
    }
    shared.take_all();
  }
  if (shared.failure()) std::rethrow_exception(shared.failure());
  if (!shared.all_done()) stop_if_interrupted(doing);
}

}  // namespace talus
