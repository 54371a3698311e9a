// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/geo_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/point_layer.hpp"
#include "common/gis/vertical_unit.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
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

void to_metres(ScatteredPoints& points, const std::filesystem::path& file, const std::string& vertical_unit) {
  const bool named = !points.unit.empty();
  const std::string& unit = named ? points.unit : vertical_unit;
  const double metres = metres_in(unit).value_or(1.0);
  if (metres == 1.0) return;
  for (double& z : points.z) z *= metres;
  log_info(fmt::format("{}: {} {} {}, converted to metres (x {:.10g})", file.string(),
                       points.are_depths ? "depths" : "heights", named ? "are in" : "taken as", unit, metres));
}

}  // namespace

Extent ScatteredPoints::extent() const {
  if (x.empty()) return {};
  const auto [west, east] = std::minmax_element(x.begin(), x.end());
  const auto [south, north] = std::minmax_element(y.begin(), y.end());
  return {*west, *south, *east, *north};
}

std::string metric_crs(const std::string& name) {
  std::string wkt = crs_by_name(name);
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

ScatteredPoints read_points_as_given(const std::filesystem::path& file, PointHeights heights) {
  if (is_text(file)) return read_point_table(file, heights);
  ZAttributes attributes;
  attributes.known = [](std::string_view name) {
    const auto height = height_name(name);
    return height && !height->depth;
  };
  if (heights == PointHeights::depths_or_elevations) {
    attributes.first = [](std::string_view name) {
      const auto height = height_name(name);
      return height && height->depth;
    };
  }
  PointLayer layer = read_point_layer(file, attributes);
  const HeightName z = height_name(layer.z_name).value_or(HeightName{});
  return {std::move(layer.x), std::move(layer.y), std::move(layer.z), std::move(layer.crs_wkt), z.depth, z.unit};
}

ScatteredPoints with_likely_crs(ScatteredPoints points, const std::filesystem::path& file) {
  const Extent e = points.extent();
  const bool like_degrees =
      points.crs_wkt.empty() && !points.x.empty() && e.west >= -180 && e.east <= 360 && e.south >= -90 && e.north <= 90;
  if (!like_degrees) return points;
  points.crs_wkt = crs_by_name("EPSG:4326");
  warn("taken-as-degrees",
       fmt::format("{}: x {:g}..{:g}, y {:g}..{:g} and no CRS: taken as longitude and latitude (WGS 84)", file.string(),
                   e.west, e.east, e.south, e.north));
  return points;
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

ScatteredPoints read_points(const std::filesystem::path& file, const ReadOptions& how, PointHeights heights) {
  ScatteredPoints points = read_points_as_given(file, heights);
  to_metres(points, file, how.vertical_unit);
  if (how.to_crs.empty()) {
    require_metric(points, file, how.or_else);
    return points;
  }
  points = with_likely_crs(std::move(points), file);
  if (is_metric(points.crs_wkt)) return points;
  log_info(fmt::format("{}: {} points moved from {} to {}", file.string(), points.x.size(), crs_name(points.crs_wkt),
                       crs_name(how.to_crs)));
  return transform_points(std::move(points), how.to_crs);
}

ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt) {
  transform_places(points.crs_wkt, to_wkt, points.x, points.y);
  points.crs_wkt = to_wkt;
  return points;
}

}  // namespace talus::preprocess
