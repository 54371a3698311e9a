// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/map/raster.hpp"

namespace talus {

/// Bilinear between cell centres; NaN where the cell that holds the point is NaN. Neighbours without a value give their
/// weight to the others, so that data neither shrink nor grow at the edge of a hole.
double bilinear(const Raster& source, double x, double y);

}  // namespace talus
