// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of the host that kernels can read and write: what is small comes and goes by a kernel there, without a copy
// that the host would have to start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "solver/parallel/for_each.hpp"

namespace talus {
namespace detail {
/// Memory of the host that the device's kernels see, at least as large as asked for [bytes].
void* lend_host(const CpuDevice&, std::size_t bytes);
void* lend_host(const GpuDevice& device, std::size_t bytes);
/// Gives it back; its size is that asked for.
void give_back_host(const CpuDevice&, void* memory, std::size_t bytes) noexcept;
void give_back_host(const GpuDevice& device, void* memory, std::size_t bytes) noexcept;
}  // namespace detail

/// One thread: one word.
struct CopyWord {
  const std::uint32_t* from;
  std::uint32_t* to;
  TALUS_HD void operator()(int i) const { to[i] = from[i]; }
};

/// An object on the host that kernels can copy from and to. What they write is there once the host has waited.
template <class T, class Device>
class HostRoom {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint32_t) == 0);

 public:
  explicit HostRoom(Device device)
      : device_(std::move(device)), object_(static_cast<T*>(detail::lend_host(device_, sizeof(T)))) {
    *object_ = T{};
  }
  HostRoom(const HostRoom&) = delete;
  HostRoom& operator=(const HostRoom&) = delete;
  ~HostRoom() { detail::give_back_host(device_, object_, sizeof(T)); }

  T& operator*() const { return *object_; }  ///< object, for the host
  /// The method starts a copy of the object to the memory of the device.
  void copy_to(T* memory) const { copy(object_, memory); }
  /// The method starts a copy from the memory of the device to the object.
  void copy_from(const T* memory) const { copy(memory, object_); }

 private:
  void copy(const T* from, T* to) const {
    for_each(device_, static_cast<int>(sizeof(T) / sizeof(std::uint32_t)),
             CopyWord{reinterpret_cast<const std::uint32_t*>(from), reinterpret_cast<std::uint32_t*>(to)});
  }
  Device device_;
  T* object_;
};

}  // namespace talus
