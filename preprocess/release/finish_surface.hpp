// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From depths at the cells of an outline to a sliding surface.
#pragma once

#include "preprocess/release/rim_problem.hpp"
#include "preprocess/release/sliding_surface.hpp"

namespace talus::preprocess {

/// Depths <= 0 become cells that touch the ground.
SlidingSurface finish_surface(const Raster& before, const Outline& outline, const RimProblem::Vector& depth,
                              double curvature);

}  // namespace talus::preprocess
