#include "preprocess/terrain/geo_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "common/error.hpp"
#include "common/raster/point_layer.hpp"
#include "common/raster/raster_io.hpp"
#include "preprocess/terrain/point_table.hpp"

namespace talus::preprocess {

namespace {

bool is_text(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".csv" || extension == ".xyz" || extension == ".txt";
}

/// GDAL takes a table of points for a raster when their distances happen to be multiples of one another.
bool is_sparse_table(const std::filesystem::path& file, const RasterGlance& raster) {
  return raster.driver == "XYZ" && read_point_table(file).x.size() < raster.cells;
}

}  // namespace

Extent ScatteredPoints::extent() const {
  if (x.empty()) return {};
  const auto [west, east] = std::minmax_element(x.begin(), x.end());
  const auto [south, north] = std::minmax_element(y.begin(), y.end());
  return {*west, *south, *east, *north};
}

std::string metric_crs(const std::string& name) {
  const std::string wkt = crs_by_name(name);
  if (wkt.empty()) {
    throw RecipeError(Fault{"[preprocess]: working_crs = \"" + name + "\"", "no such CRS is known",
                            "Name it by its code, as in \"EPSG:32633\""});
  }
  if (!is_metric(wkt)) {
    throw RecipeError(Fault{"[preprocess]: working_crs = \"" + name + "\"", "its coordinates are not in metres",
                            "Name a projected CRS in metres, such as the UTM zone of the place"});
  }
  return wkt;
}

bool is_point_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return false;
  if (const auto raster = glance_at_raster(file)) return is_text(file) && is_sparse_table(file, *raster);
  return is_text(file) || holds_points(file);
}

ScatteredPoints read_points_as_given(const std::filesystem::path& file) {
  if (is_text(file)) return read_point_table(file);
  PointLayer layer = read_point_layer(file, is_z_name);
  return {std::move(layer.x), std::move(layer.y), std::move(layer.z), std::move(layer.crs_wkt)};
}

void require_metric(const ScatteredPoints& points, const std::filesystem::path& file, const std::string& or_else) {
  if (is_metric(points.crs_wkt)) return;
  const Extent e = points.extent();
  const std::string zone = utm_zone_at(points.crs_wkt, 0.5 * (e.west + e.east), 0.5 * (e.south + e.north));
  throw DataError(
      Fault{fmt::format("{}: CRS is {}", file.string(), crs_name(points.crs_wkt)), "this stage needs metres",
            fmt::format("Reproject: ogr2ogr -t_srs {} {}_utm.gpkg {}{}", zone.empty() ? "EPSG:<a metric one>" : zone,
                        file.stem().string(), file.string(), or_else.empty() ? "" : "; " + or_else)});
}

ScatteredPoints read_points(const std::filesystem::path& file) {
  ScatteredPoints points = read_points_as_given(file);
  require_metric(points, file);
  return points;
}

ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt) {
  transform_places(points.crs_wkt, to_wkt, points.x, points.y);
  points.crs_wkt = to_wkt;
  return points;
}

}  // namespace talus::preprocess
