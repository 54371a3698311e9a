// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Does a checkpoint fit the scene that goes on from it? Kernels take its cells and numbers as indices.
#pragma once

#include <filesystem>

#include "solver/integrator/scene.hpp"
#include "solver/run/recorders/checkpoint.hpp"

namespace talus::solver {

/// This function throws DataError that names the first list, and the place in it, that does not fit: another count of
/// map cells or contact points, points outside the grid or far from their cell, of a release, load or material that the
/// scene does not have, two points of one id, a clock that ran backwards.
void check_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Scene& scene);

}  // namespace talus::solver
