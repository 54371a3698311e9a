// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Class limits of the report's difference map; the other maps have those of maps/styles.hpp, as in a GIS.
#pragma once

#include <vector>

namespace talus::postprocess {

/// Rising positive limits of a symmetric scale [m]: 1/5, 1/2 and the whole of a round number that nine in ten
/// differences do not exceed. NaN and 0 are left out.
std::vector<double> difference_limits(const std::vector<double>& differences);

}  // namespace talus::postprocess
