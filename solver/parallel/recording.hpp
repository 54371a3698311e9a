// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work that is given to the device again and again: recorded once, and then started as a whole (a CUDA graph), which
// takes a fraction of the time of starting its kernels one by one.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "solver/parallel/for_each.hpp"

namespace talus {

template <class Device>
class Recording;

/// On the CPU work is done as it is given.
template <>
class Recording<CpuDevice> {
 public:
  explicit Recording(const CpuDevice&, int = 1) {}
  /// The method does body() as often as `times`.
  template <class Body>
  void repeat(int times, const Body& body) {
    for (int t = 0; t < times; ++t) body();
  }
  void forget() {}  ///< does nothing: there is no recording
};

/// On a GPU work is recorded as a CUDA graph, and started as a whole from the second time on.
template <>
class Recording<GpuDevice> {
 public:
  /// The first `plain` times are done as they are: enough to keep the GPU at work for as long as recording takes.
  explicit Recording(GpuDevice device, int plain = 1) : device_(std::move(device)), plain_(plain) {}
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() {
    detail::gpu_drop(graph_);
    Profile::forget(device_, marks_);
  }

  /// The method does body() as often as `times`. It must start the same kernels with the same arguments on the
  /// recording's device every time, until forget() is called, and neither upload nor download. The first times are done
  /// as they are, so that buffers find their sizes, and all where few are left to be started from a recording.
  template <class Body>
  void repeat(int times, const Body& body) {
    const bool measured = device_.profile().with_kernels();
    if (marked_ != measured) recorded_ = false;
    for (int first = times < 2 * plain_ ? times : plain_; !recorded_ && first > 0; --first, --times) body();
    if (times > 0 && measured) return repeat_measured(times, body);
    if (!recorded_ && times > 0) record(body);
    for (int t = 0; t < times; ++t) detail::gpu_replay(device_, graph_);
  }
  void forget() { recorded_ = false; }  ///< gives up the recording, because arguments have changed

 private:
  template <class Body>
  void record(const Body& body) {
    Profile& profile = device_.profile();
    profile.begin_recording();
    detail::gpu_begin_recording(device_);
    body();
    graph_ = detail::gpu_end_recording(device_, graph_);
    marks_ = profile.end_recording();
    recorded_ = true;
    marked_ = profile.with_kernels();
  }
  /// With marks around its kernels, each time waited for.
  template <class Body>
  void repeat_measured(int times, const Body& body) {
    Profile& profile = device_.profile();
    std::optional<ProfilePhase<GpuDevice>> phase;
    if (!profile.within_phase()) phase.emplace(device_, "between kernels");
    if (!recorded_) {
      synchronise(device_);
      profile.settle(device_);  // what was started one by one until here
      Profile::forget(device_, marks_);
      record(body);
    }
    for (int t = 0; t < times; ++t) {
      detail::gpu_replay(device_, graph_);
      synchronise(device_);
      profile.take(marks_);
    }
  }

  GpuDevice device_;
  int plain_;
  void* graph_ = nullptr;
  std::vector<Profile::Mark> marks_;  ///< of its kernels, under --profile
  bool recorded_ = false, marked_ = false;
};

}  // namespace talus
