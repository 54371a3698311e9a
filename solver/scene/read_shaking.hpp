// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerograms from text files.
#pragma once

#include "solver/integrator/shaking.hpp"
#include "solver/options/shaking.hpp"

namespace talus::solver {

/// The shaking that the options ask for, in SI units, along x, y and z of the map, from `start` on; none where they
/// name neither record nor file. The function throws DataError, with the line, for what is no accelerogram: see
/// docs/reference/formats.md.
Shaking read_shaking(const ShakingOptions& options);

}  // namespace talus::solver
