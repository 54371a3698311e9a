// Rasters and polygons in and out through GDAL. The only header of the project that stands for GDAL; the solver does
// not link it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// RasterFile(file).read(), see raster_file.hpp: band 1 of any GDAL raster, in metres, NaN for nodata. A file without
/// CRS is taken as local metric coordinates; degrees, feet in the map's plane, and rasters without any value are
/// refused.
Raster read_raster(const std::filesystem::path& file);

/// True when both name the same CRS (an empty one is local and equals only an empty one).
bool same_crs(const std::string& wkt_a, const std::string& wkt_b);

/// Short name of a CRS for messages: "EPSG:32149", or the WKT's name, or "local metric coordinates".
std::string crs_name(const std::string& wkt);

enum class Interpolation { bilinear, cubic };

/// Warp onto `grid` (another CRS, extent, registration or cell size). Elevations: interpolated where the target is
/// finer, area mean where it is coarser; NaN where the source has no data.
Raster resample_elevation(const Raster& source, const MapGrid& grid,
                          Interpolation interpolation = Interpolation::bilinear);

/// Bring a thickness onto `grid` by exact area weights (same CRS only), so that the volume inside both extents is kept
/// to rounding. NaN counts as zero thickness but cells wholly outside the source are NaN.
Raster resample_thickness(const Raster& source, const MapGrid& grid);

/// A polygon with holes: rings of (x, y) [m], the first the outer one, each without the repeated closing point.
struct MapPolygon {
  std::vector<std::vector<std::array<double, 2>>> rings;
  std::vector<std::pair<std::string, double>> numbers;  ///< numeric attributes by name
  std::string name;                                     ///< attribute "name", if any
};

/// All polygons of the layer `named`, or of the first one where a vector file has none of that name (multipolygons
/// split), transformed to `crs_wkt` when both have a CRS.
std::vector<MapPolygon> read_polygons(const std::filesystem::path& file, const std::string& crs_wkt,
                                      const std::string& named = "");

/// A line of points (x, y) [m], at least two, none repeated.
using MapLine = std::vector<std::array<double, 2>>;

/// All lines of a vector file's first layer (multilines split), transformed to `crs_wkt` when both have a CRS. Throws
/// DataError: no such file, not a vector file, no line in it.
std::vector<MapLine> read_lines(const std::filesystem::path& file, const std::string& crs_wkt);

/// What a GeoTIFF says of itself beside its values.
struct RasterTags {
  std::string description;  ///< band description: "deposit thickness, vertical [m]"
  std::string unit;         ///< "m"
  std::vector<std::pair<std::string, std::string>> metadata;
};

/// A number among the metadata items of a raster file (as RasterTags writes them); empty where the item is missing or
/// no number. Throws DataError when the file cannot be opened.
std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name);

/// Write a cloud-optimised GeoTIFF (COG driver, deflate, overviews, nodata -9999, Float64 so that volumes close to
/// 1e-9), aside and renamed. Throws DataError when anything fails on the way (disk full).
void write_cog(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

/// Write a plain GeoTIFF (not COG), same conventions: for samples and intermediates.
void write_geotiff(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

}  // namespace talus
