// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names inside domain.vdb, shared by its writer and its reader, and whether its numbers are possible: every one is
// looked at before the solver uses it.
#pragma once

#include <filesystem>
#include <string>

#include <openvdb/openvdb.h>

#include "common/domain/domain.hpp"

namespace talus::layout {

/// To be raised when a reader would misread a file or miss something in it.
inline constexpr int format = 1;
inline constexpr auto kind = "talus-domain";

inline constexpr auto points = "points";
inline constexpr auto terrain = "terrain";
inline constexpr auto before = "before";
inline constexpr auto release_thickness = "release_thickness";
inline constexpr auto inside = "inside";
inline constexpr auto active = "active";
inline constexpr auto mask_h = "h_m";                 ///< of the background grid, in the metadata of "active"
inline constexpr auto mask_h_z = "h_z_m";             ///< likewise
inline constexpr auto places = "places";              ///< how many
inline constexpr auto place_of = "place_of";          ///< numbered: the [[preprocess.place]] it is of
inline constexpr auto place_name = "place_name";      ///< likewise
inline constexpr auto place_points = "place_points";  ///< likewise, as text_of_points()
inline constexpr auto findings = "findings";          ///< array of JSON
inline constexpr auto obstacles = "obstacles";        ///< likewise, their places
inline constexpr auto bed_prefix = "bed.";            ///< and the name of a number of [solve.base]

inline constexpr auto volume = "volume";
inline constexpr auto height = "height";
inline constexpr auto extent_x = "extent_x";
inline constexpr auto extent_y = "extent_y";
inline constexpr auto release = "release";
inline constexpr auto id = "id";  ///< place in SeedPoints, so that reading gives the order of writing

/// "release_name.3"
inline std::string numbered(const std::string& name, std::size_t i) { return name + "." + std::to_string(i); }

/// Index (column, row, 0) is the centre of a map cell, at `bottom` in z. The origin is the grid's corner, so that
/// points keep their digits wherever on Earth it is.
inline openvdb::math::Transform::Ptr transform(const MapGrid& grid, double layer_height, double bottom) {
  openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
  matrix.preScale(openvdb::Vec3d(grid.cell, grid.cell, layer_height));
  matrix.postTranslate(openvdb::Vec3d(grid.x(0), grid.y(0), bottom));
  return openvdb::math::Transform::createLinearTransform(matrix);
}

}  // namespace talus::layout

namespace talus {

/// Throws DataError where the grid cannot be: no cells, more than an int counts, sizes or places that are not finite.
void check_domain_grid(const std::filesystem::path& file, const MapGrid& grid, double layer_height);

/// Throws DataError that names the first number that cannot be: elevations beyond 100 km, thickness below zero, numbers
/// of the bed that [solve.base] does not know or that are not finite, points outside the map, without volume or of a
/// release that is not there, places outside the map or without a name. The grid has been checked before.
void check_domain(const std::filesystem::path& file, const Domain& domain);

}  // namespace talus
