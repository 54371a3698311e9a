// Where the time of a run goes: named phases of a step, measured when asked for (--profile) and free of cost otherwise.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "solver/parallel/place.hpp"

namespace talus {

/// Seconds by phase, of the one run of this process. A phase inside another is taken out of that one's time.
class Profile {
 public:
  struct Phase {
    std::string name;
    double seconds = 0;
    long calls = 0;
  };

  static Profile& of_run();
  void turn_on() { on_ = true; }
  void turn_off() { on_ = false; }
  bool on() const { return on_; }
  void enter(const char* name);
  void leave();
  const std::vector<Phase>& phases() const { return phases_; }  // in the order met

 private:
  using WallClock = std::chrono::steady_clock;
  void charge();
  bool on_ = false;
  std::vector<Phase> phases_;
  std::vector<std::size_t> open_;
  WallClock::time_point since_;
};

/// A phase for as long as it lives. Waits for the GPU at both ends, so that its kernels are counted and no others.
template <class Place>
class ProfilePhase {
 public:
  explicit ProfilePhase(const char* name) : on_(Profile::of_run().on()) {
    if (!on_) return;
    synchronise(Place{});
    Profile::of_run().enter(name);
  }
  ~ProfilePhase() {
    if (!on_) return;
    synchronise(Place{});
    Profile::of_run().leave();
  }
  ProfilePhase(const ProfilePhase&) = delete;
  ProfilePhase& operator=(const ProfilePhase&) = delete;

 private:
  bool on_;
};

}  // namespace talus
