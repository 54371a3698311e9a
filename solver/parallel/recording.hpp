// Work that is given to the device again and again: recorded once, and then started as a whole (a CUDA graph), which
// takes a fraction of the time of starting its kernels one by one.
#pragma once

#include <optional>

#include "solver/parallel/device.hpp"

namespace talus {

template <class Device>
class Recording;

template <>
class Recording<CpuDevice> {
 public:
  template <class Body>
  void repeat(int times, const Body& body) {
    for (int t = 0; t < times; ++t) body();
  }
  void forget() {}
};

template <>
class Recording<GpuDevice> {
 public:
  Recording() = default;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() {
    detail::gpu_drop(graph_);
    Profile::forget(marks_);
  }

  /// Does body() as often as said. It must start the same kernels with the same arguments every time, until forget() is
  /// called. The first is done as it is, so that buffers find their sizes.
  template <class Body>
  void repeat(int times, const Body& body) {
    Profile& profile = Profile::of_run();
    if (marked_ != profile.with_kernels()) recorded_ = false;
    if (!recorded_ && times > 0) {
      body();
      --times;
    }
    if (times > 0 && profile.with_kernels()) return repeat_measured(times, body);
    if (!recorded_ && times > 0) record(body);
    for (int t = 0; t < times; ++t) detail::gpu_replay(graph_);
  }
  /// Arguments have changed: record again.
  void forget() { recorded_ = false; }

 private:
  template <class Body>
  void record(const Body& body) {
    Profile& profile = Profile::of_run();
    profile.begin_recording();
    detail::gpu_begin_recording();
    body();
    graph_ = detail::gpu_end_recording(graph_);
    marks_ = profile.end_recording();
    recorded_ = true;
    marked_ = profile.with_kernels();
  }
  /// With marks around its kernels, each time waited for.
  template <class Body>
  void repeat_measured(int times, const Body& body) {
    Profile& profile = Profile::of_run();
    std::optional<ProfilePhase<GpuDevice>> phase;
    if (!profile.within_phase()) phase.emplace("between kernels");
    if (!recorded_) {
      detail::gpu_synchronise();
      profile.settle();  // what was started one by one until here
      Profile::forget(marks_);
      record(body);
    }
    for (int t = 0; t < times; ++t) {
      detail::gpu_replay(graph_);
      detail::gpu_synchronise();
      profile.take(marks_);
    }
  }

  void* graph_ = nullptr;
  std::vector<Profile::Mark> marks_;  // of its kernels, under --profile
  bool recorded_ = false, marked_ = false;
};

}  // namespace talus
