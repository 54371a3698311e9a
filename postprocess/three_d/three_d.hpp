// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// OUT/3d: a run for ParaView, as meshes and points over time.
#pragma once

#include "common/run/point_frames.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/options/writer.hpp"

namespace talus::postprocess {

/// Contents of OUT/3d.
struct ThreeDParts {
  bool surface = true;  ///< of the flow over time, as a mesh
  bool terrain = true;  ///< with the maps on it
  bool points = false;  ///< material points over time

  bool any() const { return surface || terrain || points; }
};

/// Estimated size of OUT/3d [MB of 1e6 bytes], from counts of points and cells and the packed size of each in measured
/// runs (docs/how-to/results.md).
struct ThreeDSize {
  double surface = 0, terrain = 0, points = 0;
  double all() const { return surface + terrain + points; }
};

ThreeDSize size_of_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points);

/// Logs the estimate. Throws DataError if it exceeds `most` [MB], or if points are wanted of a run without point
/// frames.
void check_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points, double most = 4000);

/// Writes the wanted files into `folder`, made where it is missing: terrain.vtp, surface.pvd, points.pvd, and run.pvd
/// with all of them. Returns the files to open. Throws DataError, Interrupted.
Files write_three_d(const std::filesystem::path& folder, const ThreeDParts& options, const Run& run,
                    const PointFrames& points);

}  // namespace talus::postprocess
