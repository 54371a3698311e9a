// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/geo_input.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/features.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/table_lines.hpp"

namespace talus::preprocess {
namespace {

bool is_text(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".csv" || extension == ".xyz" || extension == ".txt";
}

void to_metres(ScatteredPoints& points, const std::filesystem::path& file, const std::string& vertical_unit) {
  const DeclaredHeights& axis = points.heights;
  const char* const what = points.are_depths ? "depths" : "heights";
  if (axis.downwards && !points.are_depths)
    throw DataError({file.string() + ": the vertical axis of its CRS counts downwards", "this stage needs heights",
                     "Turn z, and give the file a CRS of heights; or name an attribute of depths \"depth\""});
  const bool named = !points.unit.empty(), given = !named && !vertical_unit.empty();
  const std::string& unit = named ? points.unit : given ? vertical_unit : axis.unit;
  const double metres = named || given ? metres_in(unit).value_or(1.0) : axis.metres > 0 ? axis.metres : 1.0;
  constexpr double between_feet = 1e-5;
  if (axis.metres > 0 && std::abs(metres / axis.metres - 1) > between_feet)
    warn("vertical-unit",
         fmt::format("{}: {} are taken to be in {} ({}), though the vertical axis of its CRS says {}", file.string(),
                     what, unit, named ? "the name of their column" : "vertical_unit", axis.unit));
  if (metres == 1.0) return;
  for (double& z : points.z) z *= metres;
  log_info(fmt::format("{}: {} {} {}, converted to metres (x {:.10g})", file.string(), what,
                       given ? "taken as" : "are in", unit, metres));
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), lower(name)) != names.end();
}

/// "Depth (m)" is depth in m, "depth_us_ft" depth in us ft.
struct NameAndUnit {
  std::string name, unit;
};

NameAndUnit split(std::string_view text) {
  constexpr std::string_view parting = "_-([ ])";
  const std::size_t end = std::min(text.find_first_of(parting), text.size());
  NameAndUnit result{lower(text.substr(0, end)), ""};
  for (const char c : lower(text.substr(end))) {
    const bool parts = parting.find(c) != std::string_view::npos;
    if (!parts) result.unit += c;
    if (parts && !result.unit.empty() && result.unit.back() != ' ') result.unit += ' ';
  }
  while (result.unit.ends_with(' ')) result.unit.pop_back();
  return result;
}

bool is_place_name(std::string_view text, std::initializer_list<std::string_view> names) {
  const auto [name, unit] = split(text);
  return (unit.empty() || unit == "m") && is_one_of(name, names);
}

bool is_x_name(std::string_view text) { return is_place_name(text, {"x", "easting", "east", "longitude", "lon"}); }
bool is_y_name(std::string_view text) { return is_place_name(text, {"y", "northing", "north", "latitude", "lat"}); }

struct Columns {
  std::array<std::size_t, 3> of{0, 1, 2};  // x, y, z
  HeightName z;
};

/// A unit in brackets belongs to the name before it.
std::vector<std::string> names_of_header(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words)
    if (!names.empty() && (word.starts_with('(') || word.starts_with('[')))
      names.back() += word;
    else
      names.push_back(word);
  return names;
}

/// A header is a first line that names all three columns. Depths go before elevations, which are the ground's then.
std::optional<Columns> columns_of_header(const std::vector<std::string>& words, PointHeights heights) {
  const std::vector<std::string> names = names_of_header(words);
  std::array<std::optional<std::size_t>, 3> found;
  HeightName z;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_x_name(names[i])) found[0] = i;
    if (is_y_name(names[i])) found[1] = i;
    const auto height = height_name(names[i]);
    if (!height || (height->depth ? heights == PointHeights::elevations : z.depth)) continue;
    found[2] = i;
    z = *height;
  }
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  return Columns{{*found[0], *found[1], *found[2]}, z};
}

/// Whether the coordinates may be longitudes and latitudes.
bool like_degrees(const ScatteredPoints& points) {
  const Extent e = points.extent();
  return !points.x.empty() && e.west >= -180 && e.east <= 360 && e.south >= -90 && e.north <= 90;
}

/// Throws DataError where points are in degrees or feet; `or_else` names another way out (see ReadOptions).
void require_metric(const ScatteredPoints& points, const std::filesystem::path& file, const std::string& or_else) {
  const Extent e = points.extent();
  constexpr double smallest = 1;  // [m]: no model is smaller, and one of a degree is 100 km wide
  if (points.crs_wkt.empty() && points.x.size() > 3 && like_degrees(points) &&
      std::max(e.east - e.west, e.north - e.south) < smallest)
    throw DataError({fmt::format("{}: x {:.6g}..{:.6g}, y {:.6g}..{:.6g} and no CRS", file.string(), e.west, e.east,
                                 e.south, e.north),
                     "they look like longitudes and latitudes, and this stage needs metres",
                     or_else.empty() ? "Reproject it: ogr2ogr -s_srs EPSG:4326 -t_srs EPSG:<a metric one>"
                                     : "Say so: " + or_else.substr(std::string_view("or ").size())});
  if (is_metric(points.crs_wkt)) return;
  const std::string zone = utm_zone_at(points.crs_wkt, 0.5 * (e.west + e.east), 0.5 * (e.south + e.north));
  throw DataError(
      {fmt::format("{}: CRS is {}", file.string(), crs_name(points.crs_wkt)), "this stage needs metres",
       fmt::format("Reproject: ogr2ogr -t_srs {} {}_utm.gpkg {}{}", zone.empty() ? "EPSG:<a metric one>" : zone,
                   file.stem().string(), file.string(), or_else.empty() ? "" : "; " + or_else)});
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
  if (wkt.empty())
    throw RecipeError({"[preprocess]: working_crs = \"" + name + "\"", "no such CRS is known",
                       "Name it by its code, as in \"EPSG:32633\""});
  if (!is_metric(wkt))
    throw RecipeError({"[preprocess]: working_crs = \"" + name + "\"", "its coordinates are not in metres",
                       "Name a projected CRS in metres, such as the UTM zone of the place"});
  return wkt;
}

bool is_point_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return false;
  if (const auto raster =
          glance_at_raster(file))  // also of points whose distances happen to be multiples of one another
    return is_text(file) && raster->driver == "XYZ" && read_point_table(file).x.size() < raster->cells;
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
  return {.x = std::move(layer.x),
          .y = std::move(layer.y),
          .z = std::move(layer.z),
          .crs_wkt = std::move(layer.crs_wkt),
          .are_depths = z.depth,
          .unit = z.unit,
          .heights = std::move(layer.heights)};
}

ScatteredPoints with_likely_crs(ScatteredPoints points, const std::filesystem::path& file) {
  if (!points.crs_wkt.empty() || !like_degrees(points)) return points;
  const Extent e = points.extent();
  points.crs_wkt = crs_by_name("EPSG:4326");
  warn("taken-as-degrees",
       fmt::format("{}: x {:g}..{:g}, y {:g}..{:g} and no CRS: taken as longitude and latitude (WGS 84)", file.string(),
                   e.west, e.east, e.south, e.north));
  return points;
}

ScatteredPoints read_points(const std::filesystem::path& file, const ReadOptions& how, PointHeights heights) {
  ScatteredPoints points = read_points_as_given(file, heights);
  points.heights.file = file;
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

std::optional<HeightName> height_name(std::string_view text) {
  const auto [name, unit] = split(text);
  const bool depth = name == "depth";
  const bool is_unit =
      is_one_of(unit, {"", "m", "metre", "metres", "meter", "meters", "ft", "foot", "feet", "us ft", "ft us",
                       "us survey foot", "us survey feet"});  // else part of the name: "depth of bedrock"
  if (!is_unit || (!depth && !is_one_of(name, {"z", "elevation", "elev", "height", "altitude"}))) return std::nullopt;
  return HeightName{depth, unit};
}

ScatteredPoints read_point_table(const std::filesystem::path& file, PointHeights heights) {
  TableLines lines(file, "Check the path");
  ScatteredPoints points;
  Columns columns;
  bool first = true;
  std::ptrdiff_t most = 0, usual = 0;  // numbers of a line: no more than the first line names, and as many as before
  while (lines.next()) {
    const std::vector<TableWord>& words = lines.words();
    const std::string shown = fmt::format("\"{:.60}\"", lines.text());
    if (std::exchange(first, false)) {
      std::vector<std::string> texts;
      for (const TableWord& word : words) texts.push_back(word.text);
      if (const auto named = columns_of_header(texts, heights)) {
        columns = *named;
        most = std::ssize(words);
        points.are_depths = named->z.depth;
        points.unit = named->z.unit;
        continue;
      }
    }
    const auto numbers =
        std::ranges::count_if(words, [](const TableWord& word) { return finite_number(word.text).has_value(); });
    if (usual == 0) usual = numbers;
    if (numbers > usual || (most > 0 && numbers > most))
      lines.refuse(fmt::format("{} has {} numbers", shown, numbers),
                   fmt::format("the first line {} {}", most > 0 && numbers > most ? "names" : "of numbers has",
                               most > 0 && numbers > most ? most : usual),
                   "Mend the line. Beside decimal commas, part the numbers by semicolons");
    if (const std::size_t at = grouped_by_comma(words, lines.text()); at > 0 && most == 0 && numbers > 3)
      lines.refuse(shown, "its first commas part numbers, or the thousands of one",
                   "Name the columns in a first line: x,y,z and what follows; write thousands without a sign", at);
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t at = columns.of[i];
      if (at < words.size() && is_grouped(words[at].written)) lines.number(at);
      const auto value = at < words.size() ? finite_number(words[at].text) : std::nullopt;
      if (!value)
        lines.refuse(shown, "not three numbers x, y, z", "Mend the line, or name the columns x,y,z in a first line");
      xyz[i] = *value;
    }
    points.x.push_back(xyz[0]);
    points.y.push_back(xyz[1]);
    points.z.push_back(xyz[2]);
  }
  return points;
}

}  // namespace talus::preprocess
