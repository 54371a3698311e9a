// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation models as they were read, and brought onto the working grid.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/gis/crs.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/geo_input.hpp"

namespace talus::preprocess {

/// How one survey is moved onto another.
struct Placement {
  double x = 0, y = 0, z = 0;         ///< added to its coordinates and heights [m]
  double tilt_x = 0, tilt_y = 0;      ///< rise added per metre east and north of the centre
  double centre_x = 0, centre_y = 0;  ///< [m]

  /// What is added to the height at a place [m].
  double rise(double at_x, double at_y) const { return z + tilt_x * (at_x - centre_x) + tilt_y * (at_y - centre_y); }
  bool moves() const { return x != 0 || y != 0; }
  /// True when it changes anything.
  bool given() const { return moves() || z != 0 || tilt_x != 0 || tilt_y != 0; }
};

/// A raster, or scattered points, of elevations [m].
struct Elevation {
  std::filesystem::path file;
  bool scattered = false;
  bool reprojected = false;                   // as it was read: its data end in slanting lines
  Raster raster;                              // its cells, or of one that stays in its file, nothing but the grid
  std::shared_ptr<const RasterFile> on_disk;  // read by parts, as they are needed
  std::shared_ptr<bool> has_fill;  // whether fill values were found in it, among its copies; null: of no ground
  ScatteredPoints points;
  Placement placement = {};  // in the CRS of the working grid

  /// WKT2 of the CRS of its cells or points; "" = none.
  const std::string& crs_wkt() const { return scattered ? points.crs_wkt : raster.grid.crs_wkt; }
  /// What its file declares of its heights.
  const DeclaredHeights& heights() const { return scattered ? points.heights : on_disk->heights(); }
  /// What its cells or points cover, in their own CRS [m].
  Extent extent() const;
  /// Width of its cells [m]; 0 for points, which have none.
  double cell() const { return scattered ? 0.0 : raster.grid.cell; }
};

/// How elevation models are read: what degrees and feet become, and the unit of heights. `working_crs` is the name of a
/// CRS in metres, "" where the recipe gives none; it is used for files in degrees or feet alone, and those in metres
/// are brought onto the working grid in one step, later. Throws RecipeError for a CRS not known or not in metres.
ReadOptions dem_reading(const std::string& working_crs, VerticalUnit unit);

/// The name of the UTM zone (on WGS 84) that holds the centre of an elevation model, for working_crs = "utm"; the log
/// names it. Throws DataError where the file names no CRS or lies near a pole.
std::string utm_zone_for(const std::filesystem::path& dem);

/// Read a raster by any GDAL format, or points (see is_point_file), under its key in the recipe. Throws DataError.
Elevation read_elevation(const std::string& key, const std::filesystem::path& file, const ReadOptions& how = {});

/// Copied where its cells are the grid's cells, resampled or triangulated otherwise (moved by less than a cell: by
/// six-point interpolation, which does not flatten crests); NaN where it has no data.
Raster onto_grid(const Elevation& elevation, const MapGrid& grid);

/// Says in the log how it comes onto the working grid, where its cells are not copied.
void log_resampling(const Elevation& elevation, const MapGrid& grid);

/// What it holds within an extent given in `crs_wkt`, and a few cells around.
Elevation part_of(const Elevation& elevation, const Extent& extent, const std::string& crs_wkt);

/// Thickness onto the grid, conserving volume (see resample_thickness); 0 where it has no data. Throws DataError when
/// CRS differ, when there is no overlap, or when more than 1e-9 of the volume lies outside the grid.
Raster thickness_onto_grid(const Raster& thickness, const MapGrid& grid, const std::filesystem::path& file);

/// Points without a CRS (a text file cannot name one) are taken to be in `working_crs` (a name; may be empty), else in
/// the CRS of the first other DEM that has one; the log says so.
void share_crs(const std::vector<Elevation*>& dems, const std::string& working_crs);

/// Throws DataError when one of two files has a CRS and the other has none.
void require_comparable_crs(const std::string& crs, const std::filesystem::path& file, const std::string& other_crs,
                            const std::string& other_file);

}  // namespace talus::preprocess
