// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh in the Stanford polygon format, for programs that draw volumes but read no VTK.
#pragma once

#include <array>
#include <filesystem>

#include "postprocess/three_d/vtk_file.hpp"

namespace talus::postprocess {

/// Writes points (as 32-bit floats, metres from `origin`) and quadrilaterals of `mesh` as binary PLY, aside and
/// renamed; `origin` stands in a comment. Throws DataError where it cannot be written.
void write_ply(const std::filesystem::path& file, const VtkMesh& mesh, const std::array<double, 3>& origin);

}  // namespace talus::postprocess
