// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which of two surfaces came first, by where mass went.
#pragma once

#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Refuses, unless accepted ("swapped-surveys"), that a surveyed change would have carried mass uphill: what
/// rose by more than the footprint's threshold lies higher, on average by volume, than what fell by as much, and is
/// more than a tenth of it. A survey that is no change of the surface says nothing of this.
void judge_order(const Survey& survey, const RunMaps& maps);

}  // namespace talus::postprocess
