// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What OUT/3d takes, before it is written.
#include <cmath>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/three_d/meshes.hpp"
#include "postprocess/three_d/three_d.hpp"

namespace talus::postprocess {
namespace {

// Packed bytes, as measured on the synthetic valley and Frank Slide (docs/how-to/results.md): of a cell under the flow
// 36 and 31, of a cell of the ground 17 and 21, of a point 26 and 27.
constexpr double bytes_of_a_vertex = 34, bytes_of_ground = 20, bytes_of_a_point = 27;

/// Cells that the flow covers, over all frames.
double covered_cells(const Run& run) {
  double count = 0;
  for (std::size_t i = 0; i < run.frames.time.size(); ++i)
    for (const double h : flow_thickness(run, i)) count += h > thinnest_surface ? 1 : 0;
  return count;
}

void need_points(const ThreeDOptions& options, const PointFrames& points) {
  if (points.most_points() > 0 || !options.points) return;
  throw DataError({"[postprocess.three_d] points = true",
                   "the run holds no points over time ([solve] point_frames = false, or no frame interval)",
                   "Run talus-solve with point_frames = true, or leave this out"});
}

}  // namespace

ThreeDSize size_of_three_d(const ThreeDOptions& options, const Run& run, const PointFrames& points) {
  ThreeDSize size;
  const auto cells = static_cast<double>(run.maps.grid.count());
  if (options.surface) size.surface = bytes_of_a_vertex * covered_cells(run) / 1e6;
  if (options.terrain) size.terrain = bytes_of_ground * cells / 1e6;
  if (options.points) size.points = bytes_of_a_point * static_cast<double>(points.all_points()) / 1e6;
  return size;
}

void check_three_d(const ThreeDOptions& options, const Run& run, const PointFrames& points) {
  if (!options.writes()) return;
  need_points(options, points);
  const ThreeDSize size = size_of_three_d(options, run, points);
  const auto words = fmt::format("3d/ will take about {:.3g} MB (surface {:.3g}, terrain {:.3g}, points {:.3g})",
                                 size.all(), size.surface, size.terrain, size.points);
  if (size.all() > options.largest)
    throw DataError({words, fmt::format("[postprocess.three_d] largest_MB = {:g}", options.largest),
                     "Raise it, or leave points out"});
  log_info(words);
}

}  // namespace talus::postprocess
