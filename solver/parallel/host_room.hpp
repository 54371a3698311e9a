// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of the host that kernels can read and write: what is small comes and goes with the kernels that need or make
// it, without a copy that the host would have to start.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "solver/parallel/device.hpp"

namespace talus {
namespace detail {
/// Memory of the host that the device's kernels see, at least as large as asked for [bytes].
void* lend_host(const CpuDevice&, std::size_t bytes);
void* lend_host(const GpuDevice& device, std::size_t bytes);
/// Gives it back; its size is that asked for.
void give_back_host(const CpuDevice&, void* memory, std::size_t bytes) noexcept;
void give_back_host(const GpuDevice& device, void* memory, std::size_t bytes) noexcept;
}  // namespace detail

/// An object on the host that kernels can read and write. What they write is there once the host has waited.
template <class T, class Device>
class HostRoom {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit HostRoom(Device device)
      : device_(std::move(device)), object_(static_cast<T*>(detail::lend_host(device_, sizeof(T)))) {
    *object_ = T{};
  }
  HostRoom(const HostRoom&) = delete;
  HostRoom& operator=(const HostRoom&) = delete;
  ~HostRoom() { detail::give_back_host(device_, object_, sizeof(T)); }

  T& operator*() const { return *object_; }  ///< object, at an address for host and kernels

 private:
  Device device_;
  T* object_;
};

}  // namespace talus
