// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/map/raster.hpp"

namespace talus {

/// Six-point Lagrange interpolation between cell centres, along x and along y: reproduces surfaces of the fifth degree,
/// and moves a wave of four cells by 0.008 cells too far or too short at worst, where linear and cubic interpolation
/// both do by 0.045 (of eight cells: 0.0002 and 0.010). Cubic convolution where one of the 36 cells has no value,
/// bilinear where one of the inner sixteen has none; NaN where the cell that holds the point is NaN.
double biquintic(const Raster& source, double x, double y);

}  // namespace talus
