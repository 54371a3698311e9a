// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scattered elevations out of text and vector files, and the CRS that a recipe names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/gis/crs.hpp"
#include "common/gis/raster_file.hpp"

namespace talus::preprocess {

/// Elevations, or depths, at scattered places.
struct ScatteredPoints {
  std::vector<double> x, y, z;   // [m]
  std::string crs_wkt;           // empty = local metric coordinates
  bool are_depths = false;       // by the name of their column: z is counted down from the ground
  std::string unit = {};         // of z, by the name of its column; "" = not said
  DeclaredHeights heights = {};  // what the file's CRS says of them
  /// The rectangle around all points, in their own CRS.
  Extent extent() const;
};

/// What is looked for among the columns of a file of points. Beside depths, elevations are taken for the ground's.
enum class PointHeights { elevations, depths_or_elevations };

/// WKT2 of a CRS named in the recipe ("EPSG:32149"). Throws RecipeError when unknown or not in metres.
std::string metric_crs(const std::string& name);

/// True for a vector file of points, or a text file (.csv, .xyz, .txt) of x, y, z that is no gapless raster.
bool is_point_file(const std::filesystem::path& file);

/// Points as they lie in their file, whatever their CRS. A header line names the columns x, y, z (any order and case;
/// also easting, northing, longitude, latitude, elevation, height, and depth where it is wanted), with or without a
/// unit behind them; without one they are the first three. Vector points carry z in their geometry or in such an
/// attribute; an attribute of depth goes before the geometry. Throws DataError with the line.
ScatteredPoints read_points_as_given(const std::filesystem::path& file,
                                     PointHeights heights = PointHeights::elevations);

/// A text file cannot name its CRS; places that all could be longitude and latitude are taken for that, with a warning.
ScatteredPoints with_likely_crs(ScatteredPoints points, const std::filesystem::path& file);

/// read_points_as_given(), in metres: z by the unit in the name of its column, else by `how.vertical_unit`, else by the
/// vertical axis of the file's CRS; places in degrees or feet moved to `how.to_crs`, and refused where that is empty.
ScatteredPoints read_points(const std::filesystem::path& file, const ReadOptions& how = {},
                            PointHeights heights = PointHeights::elevations);

/// The points in another CRS.
ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt);

/// What the name of a column says of the heights in it.
struct HeightName {
  bool depth = false;  // below the ground; else elevations
  std::string unit;    // "m", "ft", "us ft", as metres_in() knows them; "" = not said
};

/// Reads z, elevation, elev, height, altitude or depth, in any case, alone or with a unit behind it ("depth_m", "Z
/// (ft)"); nullopt for any other name.
std::optional<HeightName> height_name(std::string_view name);

/// Columns separated by commas, semicolons, tabs or blanks; '#' starts a comment. Throws DataError with the line.
ScatteredPoints read_point_table(const std::filesystem::path& file, PointHeights heights = PointHeights::elevations);

}  // namespace talus::preprocess
