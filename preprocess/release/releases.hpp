// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Releases onto a base DEM (rasters of thickness, or polygons with a thickness), and their volumes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

/// Volumes of a release of vertical thickness t on a bed of slope s, with cells of map area A.
struct Volumes {
  double volume = 0;            // sum of t A [m3]
  double volume_if_normal = 0;  // sum of t A / cos s: what numbers given as vertical would release as slope-normal [m3]
  double volume_if_vertical = 0;  // sum of t A cos s: what numbers given as slope-normal would release as vertical [m3]
  Direction given = Direction::vertical;  // how the release was given
  double projected_area = 0;              // sum of A where t > 0 [m2]
  double true_area = 0;                   // sum of A / cos s where t > 0 [m2]
  double max_vertical = 0;                // [m]
  double max_normal = 0;                  // t cos s [m]
  std::size_t cells = 0;
};

/// `cosine` as slope_cosine() gives it for the bed.
Volumes volumes_of(const Raster& thickness, const std::vector<double>& cosine);

/// Volumes as lines that people read.
std::vector<std::string> as_lines(const std::string& name, const Volumes& volumes);

/// Volumes as facts to keep with the results ("released_volume_m3", ...).
std::vector<std::pair<std::string, std::string>> as_facts(const Volumes& volumes);

struct Release {
  std::string name;
  Raster thickness;                       // vertical [m], 0 where nothing is released
  Direction given = Direction::vertical;  // as the recipe gives it
};

/// Read a release and bring it onto the grid of `bed`, its volume kept: a cell that a polygon covers in part gets that
/// part of the thickness. A slope-normal thickness t_n becomes vertical, t_n / cos(slope of the bed). Throws DataError:
/// negative or no thickness, no such attribute, polygons that are not valid or lie outside, release on nodata.
Release read_release(const ReleaseOptions& options, std::size_t item, const Raster& bed,
                     const std::filesystem::path& model);

/// Warns of releases that share ground: the later ones lie on the earlier.
void warn_of_overlap(const std::vector<Release>& releases);

}  // namespace talus::preprocess
