// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of kernel files (.cu) that run on a device of each kind, whichever the files are compiled for.
#pragma once

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// A test that is handed a device of the place that it runs in.
class OnEachDevice : public InEachPlace {
 protected:
  /// The method calls body(device).
  template <class Body>
  static void on_device(Body&& body) {
    if (GetParam() == On::cpu) body(CpuDevice::make());
#if TALUS_FOR_GPU
    if (GetParam() == On::gpu) body(GpuDevice::make());
#endif
  }
};

}  // namespace talus::solver::testing
