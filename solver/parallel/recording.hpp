// Work that is given to the device again and again: recorded once, and then started as a whole (a CUDA graph), which takes a fraction of the time of starting its kernels one
// by one.
#pragma once

#include "solver/parallel/place.hpp"
#include "solver/parallel/profile.hpp"

namespace talus {

template <class Place>
class Recording;

template <>
class Recording<OnCpu> {
 public:
  template <class Body>
  void repeat(int times, const Body& body) {
    for (int t = 0; t < times; ++t) body();
  }
  void forget() {}
};

template <>
class Recording<OnGpu> {
 public:
  Recording() = default;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() { detail::gpu_drop(graph_); }

  /// Does body() as often as said. It must start the same kernels with the same arguments every time, until forget() is called. The first is done as it is, so that
  /// buffers find their sizes; under --profile all are.
  template <class Body>
  void repeat(int times, const Body& body) {
    if (!recorded_ && times > 0) {
      body();
      --times;
    }
    if (times > 0 && Profile::of_run().on()) {
      for (int t = 0; t < times; ++t) body();
      return;
    }
    if (!recorded_ && times > 0) {
      detail::gpu_begin_recording();
      body();
      graph_ = detail::gpu_end_recording(graph_);
      recorded_ = true;
    }
    for (int t = 0; t < times; ++t) detail::gpu_replay(graph_);
  }
  /// Arguments have changed: record again.
  void forget() { recorded_ = false; }

 private:
  void* graph_ = nullptr;
  bool recorded_ = false;
};

}  // namespace talus
