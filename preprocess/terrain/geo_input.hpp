// What preprocess needs of GDAL beyond rasters and polygons: naming a CRS, moving extents, reading scattered points.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus::preprocess {

/// A rectangle in map coordinates [m].
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;
  bool empty() const { return !(west < east && south < north); }
};

/// Elevations at scattered places.
struct ScatteredPoints {
  std::vector<double> x, y, z;  // [m]
  std::string crs_wkt;          // empty = local metric coordinates
  Extent extent() const;
};

/// WKT2 of a CRS named in the recipe ("EPSG:32149"). Throws RecipeError when unknown or not in metres.
std::string metric_crs(const std::string& name);

/// Smallest rectangle in `to_wkt` around `extent` in `from_wkt`.
Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt);

/// True for a vector file of points, or a text file of x, y, z columns (.csv, .xyz, .txt) that is no gapless raster to
/// GDAL.
bool is_point_file(const std::filesystem::path& file);

/// Read it. A header line names the columns x, y, z (any order and case; also easting, northing, elevation, height);
/// without one they are the first three. Vector points carry z in their geometry or in such an attribute. Throws
/// DataError with the line.
ScatteredPoints read_points(const std::filesystem::path& file);

/// The points in another CRS.
ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt);

}  // namespace talus::preprocess
