// How fast memory can be copied: what the bytes of a kernel are held against.
#pragma once

#include "solver/parallel/device.hpp"

namespace talus {

/// Bytes read and written per second by a copy of a quarter of a gigabyte, the best of five [B/s].
double copy_bandwidth(const CpuDevice&);
double copy_bandwidth(const GpuDevice& device);

}  // namespace talus
