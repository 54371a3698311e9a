// Work done beside the run: one piece at a time, in order, its errors thrown where the next one is started.
#pragma once

#include <functional>
#include <future>
#include <utility>

namespace talus::solver {

class SideWork {
 public:
  /// Waits for the piece before; throws what that threw.
  void start(std::function<void()> work) {
    settle();
    running_ = std::async(std::launch::async, std::move(work));
  }
  /// Waits until nothing is left to do; throws what the last piece threw.
  void settle() {
    if (running_.valid()) running_.get();
  }

 private:
  std::future<void> running_;  // its destructor waits
};

}  // namespace talus::solver
