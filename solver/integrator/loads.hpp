// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on parts of the mass over time.
#pragma once

#include <vector>

#include "solver/options/loads.hpp"
#include "solver/parallel/math.hpp"

namespace talus::solver {

/// The force per volume of every load at a time [N/m3], in a step that began at `begin` [s]: what begins or ends at the
/// end of a step is none of that step's. `volumes`: of the particles that each pulls at [m3].
std::vector<Vec3<double>> load_densities(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes,
                                         double begin, double time);

/// Whether a load that pulls at something jumps at a time.
bool loads_jump(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes, double time);

}  // namespace talus::solver
