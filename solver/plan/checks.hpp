// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked for in a plan before the first step (docs/notes/plausibility.md). The functions add findings.
#pragma once

namespace talus::solver {

struct Plan;

/// Refuses what hardly any slide does: a mass that its own weight squashes ("weight-strain"), waves far slower than the
/// flow ("slow-waves"), waves faster than in any solid ("fast-waves"), loads that squash what they pull at
/// ("strong-loads"), ground that shakes as none does ("strong-shaking"). The points of the plan are placed.
void refuse_implausible(const Plan& plan);

/// Warns of a mass that gives way inside before it slides on its bed, a friction angle whose cone would carry tension,
/// grains that are lighter than the mass they make, columns one cell wide in steps in which they forget their stress,
/// inflows, shaking, and an accuracy that the ground does not allow.
void warn_of_plan(const Plan& plan);

/// Advises on fewer than four points in a cell ("points"), a stiffness that makes steps three times shorter than the
/// flow needs ("stiffness"), a friction of the bed, by any law that rubs, far from what is usual for the volume
/// (common/map/usual_reach.hpp, "friction"), an end before the mass could have come to rest ("end-time"), and a rest
/// that the energy of points would not show ("transfer"). What is too coarse about the grid talus-preprocess says.
void advise_on_plan(const Plan& plan);

}  // namespace talus::solver
