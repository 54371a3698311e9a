// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe asks that its numbers do not bear out: said before the run, with the numbers.
#pragma once

#include <string>
#include <vector>

#include "common/domain/domain.hpp"

namespace talus::solver {

struct Plan;

/// The warnings of a scene, a sentence or two each: a mass that gives way inside before it slides on its bed, a
/// friction angle whose cone would carry tension, grains that are lighter than the mass they make, columns one cell
/// wide in steps in which they forget their stress, inflows, shaking, and an accuracy that the ground does not allow.
std::vector<std::string> warnings(const Plan& plan);

/// This function says what talus-preprocess warned of, which stands in the domain: also where a run is only planned or
/// checked, a search or an ensemble is made.
void say_warnings_of_domain(const Domain& domain);

}  // namespace talus::solver
