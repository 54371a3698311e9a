// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How well a simulated quantity orders the cells of a map.
#pragma once

#include <vector>

namespace talus::postprocess {

/// Area under the receiver operating characteristic curve: the chance that a cell the survey says yes to (above
/// `threshold`) has the larger simulated value than one it says no to, ties counting half (Mann and Whitney 1947;
/// Fawcett 2006). 1 = perfect, 0.5 = chance. Over all thresholds of the simulation, unlike that of r.avaflow, which
/// takes one. Cells with NaN on either side are left out; NaN where the survey says the same everywhere.
double auroc(const std::vector<double>& simulated, const std::vector<double>& surveyed, double threshold);

}  // namespace talus::postprocess
