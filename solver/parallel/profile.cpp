#include "solver/parallel/profile.hpp"

#include <algorithm>

namespace talus {

Profile& Profile::of_run() {
  static Profile profile;
  return profile;
}

void Profile::charge() {
  const auto now = WallClock::now();
  if (!open_.empty()) phases_[open_.back()].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

void Profile::enter(const char* name) {
  charge();
  auto found = std::find_if(phases_.begin(), phases_.end(), [&](const Phase& p) { return p.name == name; });
  if (found == phases_.end()) found = phases_.insert(phases_.end(), {name, 0, 0});
  ++found->calls;
  open_.push_back(static_cast<std::size_t>(found - phases_.begin()));
}

void Profile::leave() {
  charge();
  open_.pop_back();
}

}  // namespace talus
