// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/elevation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/gis/ascii_grid.hpp"
#include "common/gis/features.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/terrain/height_statistics.hpp"
#include "preprocess/terrain/plausible_ground.hpp"
#include "preprocess/terrain/triangulation.hpp"

namespace talus::preprocess {
namespace {

/// A mean that does not pass over voids: cells that hold the centre of one are void.
void keep_voids(const Raster& raster, Raster& result) {
  const MapGrid &from = raster.grid, &to = result.grid;
  each_cell(from, [&](int column, int row) {
    if (!std::isnan(raster.at(column, row))) return;
    const double c = std::floor((from.x(column) - to.west) / to.cell),
                 r = std::floor((from.y(row) - to.south) / to.cell);
    if (c < 0 || r < 0 || c >= to.columns || r >= to.rows) return;
    result.at(static_cast<int>(c), static_cast<int>(r)) = nan;
  });
}

/// The mean of the cells within coarser ones. Where these do not hold whole cells, the mean of cells cut at their edges
/// would be off by part of a cell, which on a slope is metres of height; so cells that fit come first.
Raster coarsened(const Raster& raster, const MapGrid& grid, Interpolation interpolation) {
  const int parts = static_cast<int>(std::ceil(grid.cell / raster.grid.cell - 1e-6));
  MapGrid fine = grid;
  fine.cell = grid.cell / parts;
  fine.columns = grid.columns * parts;
  fine.rows = grid.rows * parts;
  Raster result = same_lattice(raster.grid, fine)
                      ? resample_elevation(raster, grid)
                      : resample_elevation(resample_elevation(raster, fine, interpolation), grid);
  keep_voids(raster, result);
  return result;
}

double volume_of(const Raster& thickness) {
  Sum sum;
  for (double t : thickness.values)
    if (!std::isnan(t)) sum.add(t);
  return sum.value() * thickness.grid.cell * thickness.grid.cell;
}

void require_same_crs(const Raster& thickness, const MapGrid& grid, const std::filesystem::path& file) {
  require_comparable_crs(thickness.grid.crs_wkt, file, grid.crs_wkt, "the working grid");
  if (same_crs(thickness.grid.crs_wkt, grid.crs_wkt)) return;
  const std::string wanted = crs_name(grid.crs_wkt);
  throw DataError(
      {fmt::format("{}: CRS is {}, the working grid's is {}", file.string(), crs_name(thickness.grid.crs_wkt), wanted),
       "a thickness is resampled within one CRS only, to keep its volume",
       fmt::format("Reproject: gdalwarp -t_srs {} -r average {} out.tif", wanted, file.string())});
}

const char* name_of(VerticalUnit unit) {
  switch (unit) {
    case VerticalUnit::metre: return "metre";
    case VerticalUnit::foot: return "foot";
    case VerticalUnit::us_survey_foot: return "us-survey-foot";
    case VerticalUnit::declared: break;
  }
  return "";
}

/// Pieces of a raster that its statistics are taken of, 520 x 520 cells each: 16 at most, spread evenly. They overlap
/// up to 2048 x 2048 cells, so that lines between tiles of any size lie within one.
std::vector<Raster> pieces_of(const RasterFile& file) {
  constexpr int side = 520, most = 4;
  const auto begins = [&](int cells) {
    const int count = std::min(most, (cells + side - 1) / side), last = std::max(0, cells - side);
    std::vector<int> found;
    for (int n = 0; n < count; ++n)
      found.push_back(count == 1 ? 0 : static_cast<int>(static_cast<long>(last) * n / (count - 1)));
    return found;
  };
  const int columns = std::min(side, file.grid().columns), rows = std::min(side, file.grid().rows);
  std::vector<Raster> pieces;
  for (const int row : begins(file.grid().rows))
    for (const int column : begins(file.grid().columns)) pieces.push_back(file.read({column, row, columns, rows}));
  return pieces;
}

/// As it was read, not placed.
Raster read_off(const Elevation& elevation, const MapGrid& grid) {
  const bool one_crs = same_crs(elevation.crs_wkt(), grid.crs_wkt);
  if (elevation.scattered)
    return interpolate_scattered(one_crs ? elevation.points : transform_points(elevation.points, grid.crs_wkt), grid,
                                 elevation.file);
  if (one_crs && same_lattice(elevation.raster.grid, grid)) return cut_to(elevation.raster, grid);
  const bool coarser = grid.cell > elevation.cell() * (1 + 1e-6);
  const Interpolation interpolation = elevation.placement.moves() ? Interpolation::quintic : Interpolation::bilinear;
  if (one_crs && coarser) return coarsened(elevation.raster, grid, interpolation);
  return resample_elevation(elevation.raster, grid, interpolation);
}

}  // namespace

Extent Elevation::extent() const {
  if (scattered) return points.extent();
  return {raster.grid.west, raster.grid.south, raster.grid.east(), raster.grid.north()};
}

ReadOptions dem_reading(const std::string& working_crs, VerticalUnit unit) {
  const std::string crs = working_crs.empty() ? "" : metric_crs(working_crs);
  return {.to_crs = crs, .vertical_unit = name_of(unit), .or_else = "or set working_crs = \"utm\" in [preprocess]"};
}

std::string utm_zone_for(const std::filesystem::path& dem) {
  std::string zone;
  if (!is_point_file(dem)) {
    zone = crs_name(utm_crs_of(dem));
  } else {
    const ScatteredPoints points = with_likely_crs(read_points_as_given(dem), dem);
    const Extent e = points.extent();
    zone =
        points.crs_wkt.empty() ? "" : utm_zone_at(points.crs_wkt, 0.5 * (e.west + e.east), 0.5 * (e.south + e.north));
  }
  if (zone.empty())
    throw DataError({dem.string() + ": its UTM zone cannot be told", "it names no CRS, or lies near a pole",
                     "Name the zone: working_crs = \"EPSG:326..\" (north) or \"EPSG:327..\" (south)"});
  log_info(fmt::format("working_crs: \"utm\" is {}, by the centre of {}", zone, dem.string()));
  return zone;
}

Elevation read_elevation(const std::string& key, const std::filesystem::path& file, const ReadOptions& how) {
  Elevation elevation;
  elevation.file = file;
  elevation.scattered = is_point_file(file);
  if (elevation.scattered) {
    elevation.points = read_points(file, how);
    if (!key.starts_with("bed.")) warn_of_points(elevation.points, file);
  } else {
    ReadOptions options = how;
    elevation.reprojected = !options.to_crs.empty() && !in_metres(file);
    if (!elevation.reprojected) options.to_crs.clear();
    elevation.on_disk = std::make_shared<RasterFile>(file, options);
    elevation.raster.grid = elevation.on_disk->grid();
    if (key.starts_with("bed.")) return elevation;
    elevation.has_fill = std::make_shared<bool>(false);
    warn_of_statistics(pieces_of(*elevation.on_disk), file);
  }
  return elevation;
}

Raster onto_grid(const Elevation& elevation, const MapGrid& grid) {
  const Placement& placement = elevation.placement;
  if (elevation.on_disk) {
    const Extent needed{grid.west - placement.x, grid.south - placement.y, grid.east() - placement.x,
                        grid.north() - placement.y};
    const Elevation part = part_of(elevation, needed, grid.crs_wkt);
    if (part.has_fill && !*part.has_fill) *part.has_fill = judge_fill_values(part.raster, part.file);
    return onto_grid(part, grid);
  }
  MapGrid from = grid;
  from.west -= placement.x;
  from.south -= placement.y;
  Raster result = read_off(elevation, from);
  result.grid = grid;
  if (!placement.given()) return result;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      result.at(column, row) += placement.rise(grid.x(column), grid.y(row));
  return result;
}

void log_resampling(const Elevation& elevation, const MapGrid& grid) {
  const bool one_crs = same_crs(elevation.crs_wkt(), grid.crs_wkt);
  if (elevation.scattered) {
    log_info(fmt::format("{}: {} points triangulated onto the working grid", elevation.file.string(),
                         elevation.points.x.size()));
  } else if (!one_crs || !same_lattice(elevation.raster.grid, grid)) {
    log_info(fmt::format("{}: {:g} m cells in {}{} resampled onto the working grid", elevation.file.string(),
                         elevation.cell(), crs_name(elevation.crs_wkt()),
                         one_crs && elevation.cell() == grid.cell ? ", registered otherwise," : ""));
  }
}

Elevation part_of(const Elevation& elevation, const Extent& extent, const std::string& crs_wkt) {
  Elevation part = elevation;
  if (elevation.scattered) return part;
  const Extent own =
      same_crs(crs_wkt, elevation.crs_wkt()) ? extent : transform_extent(extent, crs_wkt, elevation.crs_wkt());
  const MapGrid& grid = elevation.raster.grid;
  const auto cell_at = [&](double from, int count) {
    return std::clamp(static_cast<int>(std::floor(from / grid.cell)), 0, count - 1);
  };
  const double rim = 2 * grid.cell;
  CellWindow w;
  w.column = cell_at(own.west - grid.west - rim, grid.columns);
  w.row = cell_at(own.south - grid.south - rim, grid.rows);
  w.columns = cell_at(own.east - grid.west + rim, grid.columns) + 1 - w.column;
  w.rows = cell_at(own.north - grid.south + rim, grid.rows) + 1 - w.row;
  part.raster = elevation.on_disk ? elevation.on_disk->read(w) : cut(elevation.raster, w);
  part.on_disk.reset();
  return part;
}

Raster thickness_onto_grid(const Raster& thickness, const MapGrid& grid, const std::filesystem::path& file) {
  require_same_crs(thickness, grid, file);
  Raster result = same_lattice(thickness.grid, grid) ? cut_to(thickness, grid) : resample_thickness(thickness, grid);
  const auto has_data = [](double t) { return !std::isnan(t); };
  const bool overlaps = std::ranges::any_of(result.values, has_data);
  for (double& t : result.values) t = std::isnan(t) ? 0.0 : t;
  const double whole = volume_of(thickness), kept = volume_of(result);
  if (!overlaps || kept < whole * (1 - 1e-9))
    throw DataError({fmt::format("{}: {} of {} m3 lie outside the working grid", file.string(), grouped(whole - kept),
                                 grouped(whole)),
                     "the release must lie on the DEM",
                     "Give a DEM that reaches further, or widen the crop in [preprocess.grid]"});
  return result;
}

void share_crs(const std::vector<Elevation*>& dems, const std::string& working_crs) {
  std::string shared = working_crs.empty() ? "" : metric_crs(working_crs);
  for (const Elevation* dem : dems) shared = shared.empty() ? dem->crs_wkt() : shared;
  if (shared.empty()) return;
  for (Elevation* dem : dems) {
    if (!dem->scattered || !dem->points.crs_wkt.empty()) continue;
    dem->points.crs_wkt = shared;
    log_info(fmt::format("{}: names no CRS, taken as {}", dem->file.string(), crs_name(shared)));
  }
}

void require_comparable_crs(const std::string& crs, const std::filesystem::path& file, const std::string& other_crs,
                            const std::string& other_file) {
  if (crs.empty() == other_crs.empty()) return;
  const std::string bare = crs.empty() ? file.string() : other_file, named = crs.empty() ? other_file : file.string();
  const std::string name = crs_name(crs.empty() ? other_crs : crs);
  // What has no code is taken out of the other file by the shell, and an ASCII grid has its CRS in a file beside.
  const bool by_code = name.find(':') != std::string::npos && name.find(' ') == std::string::npos;
  const auto raster = glance_at_raster(bare);
  const std::string mend = raster && raster->driver == "XYZ"
                               ? fmt::format("gdal_translate -a_srs {} {} {}",
                                             by_code ? name : fmt::format("\"$(gdalsrsinfo -o wkt {})\"", named), bare,
                                             std::filesystem::path(bare).replace_extension(".tif").string())
                           : gdal::begins_as_ascii_grid(bare)
                               ? fmt::format("gdalsrsinfo -o wkt1 {} | sed '/^$/d' > {}", by_code ? name : named,
                                             std::filesystem::path(bare).replace_extension(".prj").string())
                               : fmt::format("gdal_edit.py -a_srs {} {}",
                                             by_code ? name : fmt::format("\"$(gdalsrsinfo -o wkt {})\"", named), bare);
  throw DataError({fmt::format("{}: has no CRS, while that of {} is {}", bare, named, name),
                   "they cannot be laid over one another", "If it is the same, say so: " + mend});
}

}  // namespace talus::preprocess
