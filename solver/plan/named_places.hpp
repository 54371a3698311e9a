// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sections, gauges and inflows that lie where domain.vdb has lines and points for them.
#pragma once

#include <string>
#include <vector>

#include "common/domain/domain_place.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The options with coordinates in the place of `place`: a section for each line that is asked for, a gauge for each
/// point, the line of an inflow. Options that ask for no place stay as they are. Throws RecipeError, which names every
/// item at fault: a place or a name that the domain does not have, a point in the place of a line and the other way
/// round, a line of an inflow that is not straight, a name given twice.
SolveOptions with_places(SolveOptions options, const std::vector<DomainPlace>& places);

/// The places of a domain that nothing of `asked`, the options before with_places(), asks for: a line on each.
std::vector<std::string> idle_places(const SolveOptions& asked, const std::vector<DomainPlace>& places);

}  // namespace talus::solver
