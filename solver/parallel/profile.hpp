// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the time of a run goes: named phases of a step and the kernels in them, measured when asked for (--profile) and
// free of cost otherwise.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

class CpuDevice;
class GpuDevice;

namespace detail {
/// An event behind all that was started on the device; part of the recording while there is one.
void* gpu_mark(const GpuDevice& device);
double gpu_seconds_between(void* first, void* second);
/// Keeps the event for a later mark.
void gpu_forget_mark(const GpuDevice& device, void* mark);
}  // namespace detail

/// Seconds by phase and kernel of the work that one device is given. A phase inside another is not in that one's time.
class Profile {
 public:
  struct Phase {
    std::string name;
    double seconds = 0;
    long calls = 0;
  };
  /// A kernel of a phase, with its time and the memory it moves.
  struct Kernel {
    std::string name;
    std::size_t phase = 0;  ///< index into phases()
    double seconds = 0;     ///< on a GPU: of the device alone
    double bytes = 0;       ///< that it has to move, each read or written once; 0 where that is not known
    long calls = 0;
  };
  /// A kernel between two marks on the device.
  struct Mark {
    std::size_t kernel = 0;
    double bytes = 0;
    void *begin = nullptr, *end = nullptr;
  };

  /// The method turns measuring on. With `kernels` they are timed too, not phases alone: what is marked kernel by
  /// kernel does not overlap, and takes longer.
  void turn_on(bool kernels = true) {
    on_ = true;
    kernels_too_ = kernels;
  }
  void turn_off() { on_ = false; }  ///< turns measuring off; what was measured stays
  /// The method forgets what was measured so far; it is called between phases.
  void clear() {
    phases_.clear();
    kernels_.clear();
  }
  bool on() const { return on_; }                                  ///< whether phases are measured
  bool with_kernels() const { return on_ && kernels_too_; }        ///< whether kernels are measured too
  void enter(const char* name);                                    ///< opens a phase within the present one
  void leave();                                                    ///< closes the phase opened last
  bool within_phase() const { return !open_.empty(); }             ///< whether a phase is open
  const std::vector<Phase>& phases() const { return phases_; }     ///< all phases in the order met
  const std::vector<Kernel>& kernels() const { return kernels_; }  ///< all kernels in the order met

  /// The method begins a recording. Its work is named while it is recorded, and timed by its marks when it runs:
  /// nothing can wait for the device in between.
  void begin_recording() { recording_ = true; }
  std::vector<Mark> end_recording();             ///< ends the recording and returns its marks
  bool recording() const { return recording_; }  ///< whether a recording is under way
  /// The method adds the seconds between the marks, the device being done with them, to their kernels; and to their
  /// phases, out of the one that is open.
  void take(const std::vector<Mark>& marks);
  /// The method keeps the marks' events for later ones, and empties the list.
  static void forget(const GpuDevice& device, std::vector<Mark>& marks);

  std::size_t kernel(std::string_view name);  ///< index of a kernel of the present phase, new or not
  /// The method adds a call of a kernel that took `seconds` and moved `bytes`.
  void add(std::size_t kernel, double seconds, double bytes);
  void add(const Mark& mark) { marks_.push_back(mark); }  ///< keeps a mark for settle(), or for the recording
  /// The method takes the marks outside of recordings; the device is done with them.
  void settle(const GpuDevice& device);

 private:
  using WallClock = std::chrono::steady_clock;
  std::size_t find_phase(const char* name);
  void charge();
  bool on_ = false, kernels_too_ = false, recording_ = false;
  std::vector<Phase> phases_;
  std::vector<Kernel> kernels_;
  std::vector<std::size_t> open_;
  std::vector<Mark> marks_;
  WallClock::time_point since_;
};

/// A phase of the device's work, for as long as the object lives. It waits for the device at both ends, so that the
/// phase's kernels are counted and no others; in a recording it only names them.
template <class Device>
class ProfilePhase {
 public:
  ProfilePhase(const Device& device, const char* name) : device_(device), on_(device.profile().on()) {
    if (!on_) return;
    wait();
    device_.profile().enter(name);
  }
  ~ProfilePhase() {
    if (!on_) return;
    wait();
    device_.profile().leave();
  }
  ProfilePhase(const ProfilePhase&) = delete;
  ProfilePhase& operator=(const ProfilePhase&) = delete;

 private:
  void wait() const {
    if constexpr (Device::is_gpu) {
      if (device_.profile().recording()) return;
      synchronise(device_);
      device_.profile().settle(device_);
    }
  }
  Device device_;
  bool on_;
};

/// The name of a kernel's type without namespaces and arguments; of a wrapper that of what it wraps, its `Named`.
template <class Kernel>
std::string_view kernel_name() {
  if constexpr (requires { typename Kernel::Named; }) {
    return kernel_name<typename Kernel::Named>();
  } else {
    std::string_view name = __PRETTY_FUNCTION__;
    name.remove_prefix(name.find("Kernel = ") + 9);
    name = name.substr(0, name.find_first_of("<;]"));
    const auto last = name.rfind("::");
    return last == std::string_view::npos ? name : name.substr(last + 2);
  }
}

/// The memory that a kernel has to move for `count` indices [bytes], by its member bytes(count); 0 without that member.
template <class Kernel>
double kernel_bytes(const Kernel& kernel, int count) {
  if constexpr (requires { kernel.bytes(count); }) {
    return kernel.bytes(count);
  } else {
    return 0;
  }
}

/// The time of one kernel: the object is made before its start and ends after it.
template <class Device>
class KernelTime {
 public:
  template <class Kernel>
  KernelTime(const Device& device, const Kernel& kernel, int count)
      : device_(device), on_(device.profile().with_kernels()) {
    if (!on_) return;
    mark_.kernel = device_.profile().kernel(kernel_name<Kernel>());
    mark_.bytes = kernel_bytes(kernel, count);
    if constexpr (Device::is_gpu) mark_.begin = detail::gpu_mark(device_);
    begun_ = WallClock::now();
  }
  ~KernelTime() {
    if (!on_) return;
    Profile& profile = device_.profile();
    if constexpr (Device::is_gpu) {
      mark_.end = detail::gpu_mark(device_);
      profile.add(mark_);
    } else {
      profile.add(mark_.kernel, std::chrono::duration<double>(WallClock::now() - begun_).count(), mark_.bytes);
    }
  }
  KernelTime(const KernelTime&) = delete;
  KernelTime& operator=(const KernelTime&) = delete;

 private:
  using WallClock = std::chrono::steady_clock;
  const Device& device_;
  bool on_;
  Profile::Mark mark_;
  WallClock::time_point begun_;
};

}  // namespace talus
