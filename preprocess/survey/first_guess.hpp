// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// Moves the placement by the whole-cell shift, at most 16 cells either way, at which the misfit of a thinned set of
/// stable cells has the least NMAD; stays where no shift is a tenth better. A fit that starts there does not lose its
/// way among hills narrower than the shift.
void move_by_whole_cells(const std::vector<Patch>& patches, Placement& placement);

}  // namespace talus::preprocess
