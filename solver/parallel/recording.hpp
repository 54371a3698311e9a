// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work that is given to the device again and again: recorded once, and then started as a whole (a CUDA graph), which
// takes a fraction of the time of starting its kernels one by one.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/together.hpp"

namespace talus {

/// The recording of work that repeats on one device.
template <class Device>
class Recording;

/// On the CPU work is done as it is given.
template <>
class Recording<CpuDevice> {
 public:
  explicit Recording(const CpuDevice&, bool = false, int = 1) {}
  /// The method does body() as often as `times`.
  template <class Body>
  void repeat(int times, const Body& body) {
    for (int t = 0; t < times; ++t) body();
  }
  /// The same between begin() and end().
  template <class Body, class Begin, class End>
  void repeat(int times, const Body& body, const Begin& begin, const End& end) {
    begin();
    repeat(times, body);
    end();
  }
  /// Whether the work is started with that of other runs.
  static constexpr bool has_company() { return false; }
  /// The method does nothing: there is no recording.
  void forget() {}
};

namespace detail {
/// The runs beside which the device starts what it repeats; null where it starts it alone.
Together* gpu_together(const GpuDevice& device);
/// What is started on the device goes into the list as long as this lives, and is not done.
class IntoList {
 public:
  IntoList(const GpuDevice& device, LaunchList& list);
  ~IntoList();
  IntoList(const IntoList&) = delete;
  IntoList& operator=(const IntoList&) = delete;

 private:
  GpuDevice device_;
};
}  // namespace detail

/// Whether other runs start their kernels with those of a device (share_starts()).
inline bool has_company(const CpuDevice&) { return false; }
/// On a GPU they may.
inline bool has_company(const GpuDevice& device) { return detail::gpu_together(device) != nullptr; }

/// On a GPU work is recorded as a CUDA graph, and started as a whole from the second time on; or as a list of kernels
/// that are started with those of other runs, where the device shares its GPU with some (share_starts()).
template <>
class Recording<GpuDevice> {
 public:
  /// With `with_others` the work may be started with that of other runs: it does nothing but start kernels that can be
  /// (runs_with_others()) and fill with zeros. Otherwise repeat() throws std::logic_error where there are others. The
  /// first `plain` times are done as they are: enough to keep the GPU at work for as long as recording takes.
  explicit Recording(GpuDevice device, bool with_others = false, int plain = 1)
      : device_(std::move(device)), with_others_(with_others), plain_(plain) {}
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
    repeat(
        times, body, [] {}, [] {});
  }
  /// The same between begin() and end(), each done once. With others, body() may be done more often than `times`.
  template <class Body, class Begin, class End>
  void repeat(int times, const Body& body, const Begin& begin, const End& end) {
    if (begun_ && has_company()) {
      list_all(body, begin, end);
      return detail::gpu_together(device_)->run(device_, work_, times);
    }
    begin();
    repeat_alone(times, body);
    end();
    begun_ = begun_ || times > 0;
  }
  /// Whether the work is started with that of other runs.
  bool has_company() const { return with_others_ && talus::has_company(device_) && !device_.profile().on(); }
  /// The method gives up the recording, because arguments have changed.
  void forget() { recorded_ = listed_ = false; }

 private:
  template <class Body>
  void repeat_alone(int times, const Body& body) {
    const bool measured = device_.profile().with_kernels();
    if (marked_ != measured) recorded_ = false;
    for (int first = times < 2 * plain_ ? times : plain_; !recorded_ && first > 0; --first, --times) body();
    if (times > 0 && measured) return repeat_measured(times, body);
    if (!recorded_ && times > 0) record(body);
    for (int t = 0; t < times; ++t) detail::gpu_replay(device_, graph_);
  }
  /// The method lists the work where it was not since it was forgotten. Throws std::logic_error: some of it cannot be.
  template <class Body, class Begin, class End>
  void list_all(const Body& body, const Begin& begin, const End& end) {
    if (listed_) return;
    list(work_.begin, begin);
    list(work_.step, body);
    list(work_.end, end);
    work_.check();
    listed_ = true;
  }
  template <class Body>
  void list(LaunchList& list, const Body& body) {
    const detail::IntoList into(device_, list);
    body();
  }
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
  bool with_others_;
  int plain_;
  void* graph_ = nullptr;
  std::vector<Profile::Mark> marks_;  ///< of its kernels, under --profile
  bool recorded_ = false, marked_ = false;
  SharedWork work_;
  bool begun_ = false, listed_ = false;  ///< the work was done once as it is; it stands in the lists
};

}  // namespace talus
