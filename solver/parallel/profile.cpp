// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/profile.hpp"

#include <algorithm>
#include <utility>

namespace talus {

void Profile::charge() {
  const auto now = WallClock::now();
  if (!open_.empty()) phases_[open_.back()].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

std::size_t Profile::find_phase(const char* name) {
  auto found = std::find_if(phases_.begin(), phases_.end(), [&](const Phase& p) { return p.name == name; });
  if (found == phases_.end()) found = phases_.insert(phases_.end(), {name, 0, 0});
  return static_cast<std::size_t>(found - phases_.begin());
}

void Profile::enter(const char* name) {
  charge();
  open_.push_back(find_phase(name));
  if (!recording_) ++phases_[open_.back()].calls;
}

void Profile::leave() {
  charge();
  open_.pop_back();
}

std::size_t Profile::kernel(std::string_view name) {
  const std::size_t phase = open_.empty() ? find_phase("between phases") : open_.back();
  auto found = std::find_if(kernels_.begin(), kernels_.end(),
                            [&](const Kernel& k) { return k.phase == phase && k.name == name; });
  if (found == kernels_.end()) found = kernels_.insert(kernels_.end(), {std::string(name), phase, 0, 0, 0});
  return static_cast<std::size_t>(found - kernels_.begin());
}

void Profile::add(std::size_t kernel, double seconds, double bytes) {
  Kernel& k = kernels_[kernel];
  k.seconds += seconds;
  k.bytes += bytes;
  ++k.calls;
}

std::vector<Profile::Mark> Profile::end_recording() {
  recording_ = false;
  return std::exchange(marks_, {});
}

void Profile::take(const std::vector<Mark>& marks) {
  charge();
  for (const Mark& m : marks) {
    const double seconds = detail::gpu_seconds_between(m.begin, m.end);
    add(m.kernel, seconds, m.bytes);
    if (open_.empty() || kernels_[m.kernel].phase == open_.back()) continue;
    phases_[kernels_[m.kernel].phase].seconds += seconds;
    phases_[open_.back()].seconds -= seconds;
  }
}

void Profile::forget(const GpuDevice& device, std::vector<Mark>& marks) {
  for (const Mark& m : marks) {
    detail::gpu_forget_mark(device, m.begin);
    detail::gpu_forget_mark(device, m.end);
  }
  marks.clear();
}

void Profile::settle(const GpuDevice& device) {
  for (const Mark& m : marks_) add(m.kernel, detail::gpu_seconds_between(m.begin, m.end), m.bytes);
  forget(device, marks_);
}

}  // namespace talus
