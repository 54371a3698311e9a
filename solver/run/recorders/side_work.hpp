// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work done beside the run: one piece at a time, in order, its errors thrown where the next one is started.
#pragma once

#include <functional>
#include <future>
#include <utility>

#include "common/stage/context.hpp"

namespace talus::solver {

/// Work beside the run, one piece at a time.
class SideWork {
 public:
  /// The method starts `work` once the piece before is done; it throws what that threw.
  void start(std::function<void()> work) {
    settle();
    running_ = std::async(std::launch::async, [work = std::move(work), &here = context()] {
      const BindContext bind(here);
      work();
    });
  }
  /// The method waits until nothing is left to do; it throws what the last piece threw.
  void settle() {
    if (running_.valid()) running_.get();
  }

 private:
  std::future<void> running_;  ///< its destructor waits
};

}  // namespace talus::solver
