// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// Takes out of the stable and the unchanged ground what changed between the surveys: connected regions of 20 cells and
/// more whose misfit stands out by more than three NMAD in most cells of their surroundings, and three cells around
/// them.
void leave_out_changed(std::vector<Patch>& patches, const Placement& placement);

}  // namespace talus::preprocess
