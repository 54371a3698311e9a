// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/map/raster.hpp"

namespace talus {

/// Cubic convolution between cell centres (R. Keys 1981, "Cubic convolution interpolation for digital image
/// processing", a = -1/2): reproduces quadratic surfaces. Bilinear where one of the sixteen cells has no value; NaN
/// where the cell that holds the point is NaN.
double bicubic(const Raster& source, double x, double y);

}  // namespace talus
