// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The histories of two runs as curves of a page.
#pragma once

#include <string>

#include "postprocess/compare/compare.hpp"

namespace talus::postprocess {

/// A round step of an axis that divides `range` into four to ten parts; `range` above 0.
double axis_step(double range);

/// Charts (SVG, as markup of a page) of what both histories or one of them holds, from all of their records: kinetic
/// energy, largest speed, volume in motion, and what was measured at places. The first run solid, the second dashed.
/// Empty where neither has a history.
std::string history_charts(const ComparedRun& first, const ComparedRun& second);

}  // namespace talus::postprocess
