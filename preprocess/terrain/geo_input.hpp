// Scattered elevations out of text and vector files, and the CRS that a recipe names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/raster/coordinates.hpp"

namespace talus::preprocess {

/// Elevations at scattered places.
struct ScatteredPoints {
  std::vector<double> x, y, z;  // [m]
  std::string crs_wkt;          // empty = local metric coordinates
  Extent extent() const;
};

/// WKT2 of a CRS named in the recipe ("EPSG:32149"). Throws RecipeError when unknown or not in metres.
std::string metric_crs(const std::string& name);

/// True for a vector file of points, or a text file of x, y, z columns (.csv, .xyz, .txt) that is no gapless raster to
/// GDAL.
bool is_point_file(const std::filesystem::path& file);

/// Points as they lie in their file, whatever their CRS. A header line names the columns x, y, z (any order and case;
/// also easting, northing, longitude, latitude, elevation, height); without one they are the first three. Vector points
/// carry z in their geometry or in such an attribute. Throws DataError with the line.
ScatteredPoints read_points_as_given(const std::filesystem::path& file);

/// Throws DataError where points are in degrees or feet; `or_else` names another way out (see ReadOptions).
void require_metric(const ScatteredPoints& points, const std::filesystem::path& file, const std::string& or_else = "");

/// read_points_as_given(), in metres.
ScatteredPoints read_points(const std::filesystem::path& file);

/// The points in another CRS.
ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt);

}  // namespace talus::preprocess
