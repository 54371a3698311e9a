// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How fast memory can be copied: what the bytes of a kernel are held against.
#pragma once

#include "solver/parallel/device.hpp"

namespace talus {

/// The bytes read and written per second by a copy of a quarter of a gigabyte, the best of five [B/s].
double copy_bandwidth(const CpuDevice&);
/// On a GPU both copies are in its memory [B/s].
double copy_bandwidth(const GpuDevice& device);

}  // namespace talus
