// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The devices that kernels run on: CpuDevice (oneTBB) and GpuDevice (CUDA), both in one binary, and AnyDevice, one of
// them that is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "solver/parallel/profile.hpp"

struct CUstream_st;  // CUDA's

namespace talus {

/// The resources of one GpuDevice; see gpu_state.hpp.
struct GpuState;
template <class T, class Device>
class Buffer;

/// The cores of this machine. A handle: copies share one profile. Work of two devices may be started by two threads at
/// a time; one device takes work from one thread at a time.
class CpuDevice {
 public:
  static constexpr bool is_gpu = false;
  static CpuDevice make();  ///< a device with a profile of its own

  Profile& profile() const { return *profile_; }  ///< times of the kernels that were started on this device

 private:
  template <class T, class Device>
  friend class Buffer;
  CpuDevice() = default;  // no device
  explicit CpuDevice(std::shared_ptr<Profile> profile) : profile_(std::move(profile)) {}
  std::shared_ptr<Profile> profile_;
};

/// A GPU with a stream of its own, on which all its kernels, copies and fills run in the order they were started. A
/// handle: copies share stream, scratch memory and profile, which end with the last of them (a Buffer holds one). Two
/// devices may be of one GPU; their work does not wait for one another. Each takes work from one thread at a time.
class GpuDevice {
 public:
  static constexpr bool is_gpu = true;
  /// A new stream on the GPU of that index, 0 <= index < count(). Throws std::runtime_error where CUDA has none, and
  /// std::logic_error in a binary without CUDA.
  static GpuDevice make(int index = 0);
  /// Several GPUs of this host as one device: large kernels and buffers are shared among them, the rest is the first
  /// one's. Throws RecipeError where they cannot read one another's memory.
  static GpuDevice make(const std::vector<int>& indices);
  static int count();  ///< number of GPUs that CUDA sees; 0 in a binary without CUDA

  int index() const;            ///< number of the GPU, or the first, 0 <= index() < count()
  std::string name() const;     ///< such as "NVIDIA H200", of several "2 x NVIDIA H200"
  CUstream_st* stream() const;  ///< stream of the device
  Profile& profile() const;     ///< times of the kernels that were started on this device
  /// The resources of the device, for the functions of solver/parallel.
  GpuState& state() const { return *state_; }

 private:
  template <class T, class Device>
  friend class Buffer;
  friend struct GpuState;
  GpuDevice() = default;  // no device
  explicit GpuDevice(std::shared_ptr<GpuState> state) : state_(std::move(state)) {}
  std::shared_ptr<GpuState> state_;
};

/// Whether this binary holds GPU kernels and the machine has a device they run on.
bool gpu_available();
/// Whether this process has made a GpuDevice.
bool gpu_was_used();

/// Waits until all that was started on the device is done; it throws std::runtime_error where a kernel has failed.
inline void synchronise(const CpuDevice&) {}
/// On a GPU the host waits for the stream.
void synchronise(const GpuDevice& device);

namespace detail {

/// Uninitialised memory [bytes]; throws NumericalError where there is not enough.
void* allocate(const CpuDevice&, std::size_t bytes);
void* allocate(const GpuDevice& device, std::size_t bytes);
/// Frees memory of the size that was asked for [bytes].
void free(const CpuDevice&, void* memory, std::size_t bytes) noexcept;
void free(const GpuDevice& device, void* memory, std::size_t bytes) noexcept;

/// Copies into the device's memory. `host` may be written over when the call returns.
void upload(const CpuDevice&, void* to, const void* host, std::size_t bytes);
void upload(const GpuDevice& device, void* to, const void* host, std::size_t bytes);
/// Copies out of the device's memory, once all that was started on the device is done.
void download(const CpuDevice&, void* host, const void* from, std::size_t bytes);
void download(const GpuDevice& device, void* host, const void* from, std::size_t bytes);
void fill_zero(const CpuDevice&, void* memory, std::size_t bytes);
void fill_zero(const GpuDevice& device, void* memory, std::size_t bytes);

/// Makes the device's GPU the one that this thread's CUDA calls mean.
void gpu_select(const GpuDevice& device);
/// Throws std::runtime_error where the last start of a kernel failed.
void gpu_check_launch(const char* where);
/// True where a kernel may come onto the device before the one before it has ended.
bool gpu_starts_early(const GpuDevice& device);
/// The number of GPUs that share a kernel of so many threads, the first one selected: 1 where it has few for each. With
/// more, all of them wait for what was started before, until gpu_end_shares().
int gpu_begin_shares(const GpuDevice& device, std::int64_t threads);
/// Makes the GPU of share n the one that this thread's CUDA calls mean, and returns its stream.
CUstream_st* gpu_share(const GpuDevice& device, int n);
/// What is started on the device from here on waits for all shares.
void gpu_end_shares(const GpuDevice& device);

/// What is started on the device from here on is recorded, and not done.
void gpu_begin_recording(const GpuDevice& device);
/// Ends the recording and returns it as a graph; `before`, an earlier one or null, is updated or destroyed.
void* gpu_end_recording(const GpuDevice& device, void* before);
void gpu_replay(const GpuDevice& device, void* graph);
void gpu_drop(void* graph);

}  // namespace detail
}  // namespace talus
namespace talus {

/// A CpuDevice or a GpuDevice; a handle, as they are.
class AnyDevice {
 public:
  AnyDevice(CpuDevice device) : device_(std::move(device)) {}
  AnyDevice(GpuDevice device) : device_(std::move(device)) {}

  bool is_gpu() const { return std::holds_alternative<GpuDevice>(device_); }  ///< whether the device is a GPU
  /// The device as a CpuDevice; throws std::bad_variant_access where it is a GPU.
  const CpuDevice& cpu() const { return std::get<CpuDevice>(device_); }
  /// The device as a GpuDevice; throws std::bad_variant_access where it is the CPU.
  const GpuDevice& gpu() const { return std::get<GpuDevice>(device_); }
  /// The times of the kernels that were started on this device.
  Profile& profile() const { return is_gpu() ? gpu().profile() : cpu().profile(); }

 private:
  std::variant<CpuDevice, GpuDevice> device_;
};

/// The name of a GPU, or of this machine's processor.
std::string hardware_of(const AnyDevice& device);

}  // namespace talus
