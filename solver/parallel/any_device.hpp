// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A device that is chosen at run time.
#pragma once

#include <utility>
#include <variant>

#include "solver/parallel/device.hpp"

namespace talus {

/// A CpuDevice or a GpuDevice; a handle, as they are.
class AnyDevice {
 public:
  AnyDevice(CpuDevice device) : device_(std::move(device)) {}
  AnyDevice(GpuDevice device) : device_(std::move(device)) {}

  /// Whether the device is a GPU.
  bool is_gpu() const { return std::holds_alternative<GpuDevice>(device_); }
  /// The device as a CpuDevice; throws std::bad_variant_access where it is a GPU.
  const CpuDevice& cpu() const { return std::get<CpuDevice>(device_); }
  /// The device as a GpuDevice; throws std::bad_variant_access where it is the CPU.
  const GpuDevice& gpu() const { return std::get<GpuDevice>(device_); }
  /// The times of the kernels that were started on this device.
  Profile& profile() const { return is_gpu() ? gpu().profile() : cpu().profile(); }

 private:
  std::variant<CpuDevice, GpuDevice> device_;
};

}  // namespace talus
