// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Templates of the linear algebra are compiled once, at the foot of their .cu: for both precisions, both devices and
// all shapes.
#pragma once

#include "solver/grid/shape_functions.hpp"
#include "solver/parallel/device.hpp"

#define TALUS_FOR_EACH_SHAPE(instantiate, Real, Device) \
  instantiate(Real, Device, Linear) instantiate(Real, Device, Quadratic) instantiate(Real, Device, Gimp)
#define TALUS_FOR_EACH_PRECISION(instantiate, Device) \
  TALUS_FOR_EACH_SHAPE(instantiate, float, Device) TALUS_FOR_EACH_SHAPE(instantiate, double, Device)

/// instantiate(Real, Device, Shape) for all there are.
#if TALUS_FOR_GPU
#define TALUS_FOR_EACH_INSTANCE(instantiate) \
  TALUS_FOR_EACH_PRECISION(instantiate, CpuDevice) TALUS_FOR_EACH_PRECISION(instantiate, GpuDevice)
#else
#define TALUS_FOR_EACH_INSTANCE(instantiate) TALUS_FOR_EACH_PRECISION(instantiate, CpuDevice)
#endif
