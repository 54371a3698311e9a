// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/crs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "common/gis/gdal_support.hpp"

namespace talus {
namespace {

/// The EPSG code, also where the WKT does not carry it but is known to be it (a .prj file by Esri).
std::string identified(OGRSpatialReference srs) {
  if (srs.GetAuthorityCode(nullptr) == nullptr) srs.AutoIdentifyEPSG();
  const char* code = srs.GetAuthorityCode(nullptr);
  return code == nullptr ? "" : code;
}

gdal::Transformation between(const std::string& from_wkt, const std::string& to_wkt) {
  return gdal::transformation(gdal::spatial_reference(from_wkt), gdal::spatial_reference(to_wkt));
}

constexpr double foot = 0.3048;                     // international, exactly
constexpr double us_survey_foot = 1200.0 / 3937.0;  // exactly, by its definition of 1893

/// Lower case, words parted by single blanks: "US_Survey-Foot" becomes "us survey foot".
std::string plain(const std::string& unit) {
  std::string text;
  for (const char c : unit) {
    const auto u = static_cast<unsigned char>(c);
    const bool parts = std::isspace(u) != 0 || c == '_' || c == '-' || c == '(' || c == ')';
    if (!parts) text += static_cast<char>(std::tolower(u));
    if (parts && !text.empty() && text.back() != ' ') text += ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

bool is_one_of(const std::string& text, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

bool of_another_quantity(const std::string& text) {
  const bool words_only =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0 || c == ' '; });
  return !words_only ||
         is_one_of(text, {"deg", "degree", "degrees", "rad", "radian", "radians", "pa", "kpa", "mpa", "s", "second",
                          "seconds", "none", "unknown", "unitless", "dimensionless", "n a", "percent"});
}

constexpr double half = 50;  // [m] on the map: short beside the ellipsoid's curvature, long beside rounding

/// Radii of curvature at a latitude [m].
struct Radii {
  double meridian, parallel;
};

Radii radii_of(const OGRSpatialReference& srs, double latitude) {
  const double a = srs.GetSemiMajor(), inverse = srs.GetInvFlattening(), f = inverse > 0 ? 1 / inverse : 0;
  const double e2 = f * (2 - f), sine = std::sin(latitude), w = 1 - e2 * sine * sine;
  return {a * (1 - e2) / std::pow(w, 1.5), a / std::sqrt(w) * std::cos(latitude)};
}

}  // namespace

bool same_crs(const std::string& wkt_a, const std::string& wkt_b) {
  if (wkt_a.empty() || wkt_b.empty()) return wkt_a.empty() && wkt_b.empty();
  if (wkt_a == wkt_b) return true;
  const gdal::QuietErrors errors;
  const OGRSpatialReference a = gdal::spatial_reference(wkt_a);
  const OGRSpatialReference b = gdal::spatial_reference(wkt_b);
  const std::array<const char*, 3> options{"CRITERION=EQUIVALENT", "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  if (a.IsSame(&b, options.data()) != 0) return true;
  const std::string code = identified(a);
  return !code.empty() && code == identified(b);
}

std::string crs_name(const std::string& wkt) {
  if (wkt.empty()) return "local metric coordinates";
  const gdal::QuietErrors errors;
  OGRSpatialReference srs = gdal::spatial_reference(wkt);
  if (srs.GetAuthorityCode(nullptr) == nullptr) srs.AutoIdentifyEPSG();
  return gdal::short_name(srs);
}

std::string crs_by_name(const std::string& name) {
  const gdal::QuietErrors errors;
  OGRSpatialReference srs;
  return srs.SetFromUserInput(name.c_str()) == OGRERR_NONE ? gdal::horizontal_wkt(&srs) : "";
}

std::string crs_projjson(const std::string& wkt) {
  const gdal::QuietErrors errors;
  OGRSpatialReference srs;
  char* json = nullptr;
  const bool known = srs.importFromWkt(wkt.c_str()) == OGRERR_NONE &&
                     srs.exportToPROJJSON(&json, nullptr) == OGRERR_NONE && json != nullptr;
  std::string text = known ? json : "";
  CPLFree(json);
  return text;
}

bool is_metric(const std::string& wkt) {
  if (wkt.empty()) return true;
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = gdal::spatial_reference(wkt);
  return !srs.IsGeographic() && std::abs(srs.GetLinearUnits() - 1) <= 1e-9;
}

std::string utm_zone_at(const std::string& wkt, double x, double y) {
  const gdal::QuietErrors errors;
  const std::string zone = gdal::utm_zone(gdal::spatial_reference(wkt), x, y);
  return zone.find('<') == std::string::npos ? zone : "";
}

Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt) {
  const gdal::QuietErrors errors;
  Extent moved;
  constexpr int edge_points = 21;
  if (between(from_wkt, to_wkt)
          ->TransformBounds(extent.west, extent.south, extent.east, extent.north, &moved.west, &moved.south,
                            &moved.east, &moved.north, edge_points) == 0)
    throw DataError(
        {"an extent cannot be moved between two CRS", errors.text(), "Check its coordinates and CRS with gdalinfo"});
  return moved;
}

void transform_places(const std::string& from_wkt, const std::string& to_wkt, std::vector<double>& x,
                      std::vector<double>& y) {
  const gdal::QuietErrors errors;
  if (between(from_wkt, to_wkt)->Transform(static_cast<int>(x.size()), x.data(), y.data()) == 0)
    throw DataError({"points cannot be moved between two CRS", errors.text(),
                     "Check their coordinates, or reproject them beforehand: ogr2ogr -t_srs"});
}

bool is_no_length(const std::string& unit) {
  const std::string text = plain(unit);
  return text.empty() || of_another_quantity(text);
}

std::optional<double> metres_in(const std::string& unit) {
  const std::string text = plain(unit);
  if (is_no_length(unit)) return 1.0;
  if (has(text, "foot") || has(text, "feet") || is_one_of(text, {"ft", "ft us", "us ft", "sft", "ftus", "usft"}))
    return has(text, "us") || has(text, "u s") || has(text, "survey") || text == "sft" ? us_survey_foot : foot;
  if (text == "cm" || has(text, "centimet")) return 0.01;
  if (text == "dm" || has(text, "decimet")) return 0.1;
  if (text == "mm" || has(text, "millimet")) return 0.001;
  if (text == "km" || has(text, "kilomet")) return 1000.0;
  if (text == "m" || text.starts_with("metre") || text.starts_with("meter") || text.starts_with("m ")) return 1.0;
  return std::nullopt;
}

double GroundScale::falsity() const {
  return std::max({std::abs(x - 1), std::abs(y - 1), std::abs(std::sqrt(area) - 1)});
}

std::optional<GroundScale> ground_scale_at(const std::string& crs_wkt, double x, double y) {
  if (crs_wkt.empty()) return std::nullopt;
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = gdal::spatial_reference(crs_wkt);
  if (!srs.IsProjected()) return std::nullopt;
  const std::unique_ptr<OGRSpatialReference> geographic(srs.CloneGeogCS());
  if (!geographic) return std::nullopt;
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const gdal::Transformation way(OGRCreateCoordinateTransformation(&srs, geographic.get()));
  std::array<double, 5> xs{x, x - half, x + half, x, x}, ys{y, y, y, y - half, y + half};
  if (!way || way->Transform(5, xs.data(), ys.data()) == 0) return std::nullopt;
  const double radian = geographic->GetAngularUnits();
  const Radii radii = radii_of(srs, ys[0] * radian);
  const auto east = [&](std::size_t a, std::size_t b) {
    return std::remainder((xs.at(b) - xs.at(a)) * radian, 2 * std::numbers::pi) * radii.parallel;
  };
  const auto north = [&](std::size_t a, std::size_t b) { return (ys.at(b) - ys.at(a)) * radian * radii.meridian; };
  const double xe = east(1, 2), xn = north(1, 2), ye = east(3, 4), yn = north(3, 4);
  const GroundScale scale{2 * half / std::hypot(xe, xn), 2 * half / std::hypot(ye, yn),
                          4 * half * half / std::abs(xe * yn - xn * ye)};
  if (!std::isfinite(scale.x) || !std::isfinite(scale.y) || !std::isfinite(scale.area)) return std::nullopt;
  return scale;
}

std::optional<GridScale> grid_scale(const MapGrid& grid) {
  std::optional<GridScale> found;
  const double middle_x = 0.5 * (grid.west + grid.east()), middle_y = 0.5 * (grid.south + grid.north());
  for (const auto& [x, y] : {std::pair{middle_x, middle_y},
                             {grid.west, grid.south},
                             {grid.west, grid.north()},
                             {grid.east(), grid.south},
                             {grid.east(), grid.north()}}) {
    const auto scale = ground_scale_at(grid.crs_wkt, x, y);
    if (!scale) continue;
    if (!found) found = GridScale{*scale, *scale};
    if (scale->falsity() > found->worst.falsity()) found->worst = *scale;
  }
  return found;
}

}  // namespace talus
