// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// OUT/3d: a run for ParaView, as meshes and points over time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/point_frames.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/three_d.hpp"

namespace talus::postprocess {

/// What OUT/3d will take, about, in MB of 1e6 bytes: from counts of points and cells and what each of them took
/// in runs that were measured (docs/how-to/results.md).
struct ThreeDSize {
  double surface = 0, terrain = 0, points = 0;
  double all() const { return surface + terrain + points; }
};

ThreeDSize size_of_three_d(const ThreeDOptions& options, const Run& run, const PointFrames& points);

/// Says how much OUT/3d will take. Throws DataError: more than is allowed; points of a run that has none.
void check_three_d(const ThreeDOptions& options, const Run& run, const PointFrames& points);

/// Removes what an earlier run left in `folder`, by the names that write_three_d() gives.
void remove_three_d(const std::filesystem::path& folder);

/// Writes what `options` ask for into `folder`, made where it is missing: SCENE.pvd (all of it), surface.pvd,
/// points.pvd, terrain.vtp. Returns the files to open. Throws DataError,
/// Interrupted.
std::vector<std::filesystem::path> write_three_d(const std::filesystem::path& folder, const ThreeDOptions& options,
                                                 const Run& run, const PointFrames& points);

}  // namespace talus::postprocess
