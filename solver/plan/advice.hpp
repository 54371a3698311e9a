// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe could do better: said by --check, by --plan, before a run and in the report, with what to change.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace talus::solver {

struct Plan;

/// A piece of advice: a name for files, and a sentence or two with numbers and keys.
using Advice = std::vector<std::pair<std::string, std::string>>;

/// The advice for a scene with settled options: fewer than four points in a cell ("points"), a stiffness that makes
/// steps three times shorter than the flow needs ("stiffness"), a friction of the bed, by any law that rubs, far from
/// what is usual for the volume (common/map/usual_reach.hpp, "friction"), an end before the mass could have come to
/// rest ("end-time"), and a rest that the energy of points would not show ("transfer"). What is too coarse about the
/// grid talus-preprocess says.
Advice advice(const Plan& plan);

}  // namespace talus::solver
