// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any GDAL raster into memory, whole or by windows, or a refusal with the command that mends the file.
#include "common/gis/raster_file.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <cpl_string.h>
#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/gis/raster_source.hpp"
#include "common/gis/resampling.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using gdal::GeoTransform;
using gdal::mended;
using gdal::QuietErrors;
using gdal::RasterSource;

void require_square_north_up(const RasterSource& source) {
  const fs::path& file = source.file();
  const GeoTransform& g = source.transform();
  if (!source.placed())
    throw DataError({file.string() + ": has no georeference", "where its cells lie is not known",
                     fmt::format("Give its edges: gdal_translate -a_ullr WEST NORTH EAST SOUTH {} {}", file.string(),
                                 mended(file, "_placed"))});
  if (g[2] != 0 || g[4] != 0 || g[1] < 0)
    throw DataError({file.string() + ": rows and columns do not run east and north",
                     "this stage needs a raster that is not rotated or mirrored",
                     fmt::format("Turn it: gdalwarp -r bilinear {} {}", file.string(), mended(file, "_north_up"))});
  const double width = g[1], height = std::abs(g[5]);
  if (!(width > 0) || std::abs(width - height) > 1e-6 * width)
    throw DataError({fmt::format("{}: cells are {} x {}", file.string(), width, height),
                     "this stage needs square cells",
                     fmt::format("Resample: gdalwarp -tr {0} {0} -r bilinear {1} {2}", std::min(width, height),
                                 file.string(), mended(file, "_square"))});
}

/// Degrees and feet, where no other CRS is asked for: nothing after this point converts coordinates.
void require_metres(const RasterSource& source, const std::string& or_else) {
  if (source.in_metres()) return;
  const OGRSpatialReference& srs = *source.srs();
  const auto [x, y] = source.centre();
  const char* unit = nullptr;
  srs.GetLinearUnits(&unit);
  const std::string file = source.file().string();
  throw DataError({fmt::format("{}: CRS is {}, in {}", file, gdal::short_name(srs),
                               srs.IsGeographic() ? "degrees" : (unit == nullptr ? "an unknown unit" : unit)),
                   "this stage needs metres",
                   fmt::format("Reproject: gdalwarp -t_srs {} -r bilinear {} {}{}", gdal::utm_zone(srs, x, y), file,
                               mended(source.file(), "_utm"), or_else.empty() ? "" : "; " + or_else)});
}

void warn_if_degrees(const fs::path& file, const MapGrid& grid) {
  const bool like_degrees =
      grid.crs_wkt.empty() && grid.cell < 0.005 && std::abs(grid.west) <= 360 && std::abs(grid.north()) <= 90;
  if (like_degrees)
    warn("cells-like-degrees",
         fmt::format("{}: no CRS and cells of {}: taken as metres. If these are degrees, say so: gdal_translate -a_srs "
                     "EPSG:4326 {} {}",
                     file.string(), grid.cell, file.string(), mended(file, "_degrees")));
}

MapGrid grid_of(const RasterSource& source) {
  const GeoTransform& g = source.transform();
  const double south = g[5] < 0 ? g[3] + g[5] * source.lines() : g[3];
  MapGrid grid{source.columns(), source.lines(), g[0], south, g[1], gdal::horizontal_wkt(source.srs())};
  require_told_apart(grid, source.file().string());
  return grid;
}

bool to_be_reprojected(const RasterSource& source, const std::string& to_crs) {
  if (to_crs.empty() || source.srs() == nullptr || !source.placed()) return false;
  return !same_crs(gdal::horizontal_wkt(source.srs()), to_crs);
}

void refuse_outside(const MapGrid& grid, const CellWindow& w) {
  if (!lies_in(w, grid))
    throw std::out_of_range(fmt::format("a window of {} x {} cells at column {}, row {} of a raster of {} x {}",
                                        w.columns, w.rows, w.column, w.row, grid.columns, grid.rows));
}

}  // namespace

struct RasterFile::Parts {
  RasterSource source;
  std::optional<gdal::Warped> warped;
  MapGrid grid;
  bool north_first = true;
  mutable bool warned = false;

  Parts(const fs::path& file, const ReadOptions& options) : source(file, options) {
    if (to_be_reprojected(source, options.to_crs)) {
      warped.emplace(source, gdal::spatial_reference(options.to_crs));
      grid = warped->grid();
      log_info(fmt::format("{}: reprojected from {} to {}, cells of {:g} m", file.string(),
                           gdal::short_name(*source.srs()), crs_name(grid.crs_wkt), grid.cell));
      return;
    }
    if (source.placed()) require_metres(source, options.or_else);  // before the cells: degrees are seldom square
    require_square_north_up(source);
    grid = grid_of(source);
    north_first = source.transform()[5] < 0;
    warn_if_degrees(file, grid);
  }

  std::vector<double> lines(int column, int line, int columns, int count) {
    return warped ? warped->read(column, line, columns, count) : source.read(column, line, columns, count);
  }

  void warn_of_undeclared(std::size_t before, bool whole) const {
    const std::size_t count = source.undeclared_nodata() - before;
    if (count == 0 || warned) return;
    warned = true;
    const bool counted = whole && !warped;
    const std::string cells =
        !counted ? "cells hold" : (count == 1 ? "1 cell holds" : fmt::format("{} cells hold", count));
    warn("undeclared-nodata",
         fmt::format("{}: {} -9999 or the like, taken as nodata though the file names no such nodata value",
                     source.file().string(), cells));
  }

  bool is_whole(const CellWindow& w) const { return w.columns == grid.columns && w.rows == grid.rows; }
};

RasterFile::RasterFile(const fs::path& file, const ReadOptions& options)
    : parts_(std::make_unique<Parts>(file, options)) {}
RasterFile::RasterFile(RasterFile&&) noexcept = default;
RasterFile& RasterFile::operator=(RasterFile&&) noexcept = default;
RasterFile::~RasterFile() = default;

const fs::path& RasterFile::file() const { return parts_->source.file(); }
const MapGrid& RasterFile::grid() const { return parts_->grid; }
const DeclaredHeights& RasterFile::heights() const { return parts_->source.heights(); }

/// Some lines at a time, so that the cells are not in memory twice.
void RasterFile::each_row(const CellWindow& w, const std::function<void(int row, const double* values)>& visit) const {
  const MapGrid& whole = parts_->grid;
  const auto width = static_cast<std::size_t>(w.columns);
  const int at_once = std::max(1, static_cast<int>((std::size_t{1} << 20) / width));
  Progress progress;
  for (int done = 0; done < w.rows; done += at_once) {
    stop_if_interrupted("reading " + file().string());
    if (progress.due()) progress.update(fmt::format("{} {:.0f} %", file().string(), 100.0 * done / w.rows));
    const int count = std::min(at_once, w.rows - done);
    const int line = parts_->north_first ? whole.rows - w.row - w.rows + done : w.row + done;
    const std::vector<double> lines = parts_->lines(w.column, line, w.columns, count);
    for (int l = 0; l < count; ++l)
      visit(parts_->north_first ? w.rows - 1 - done - l : done + l, &lines[static_cast<std::size_t>(l) * width]);
  }
}

Raster RasterFile::read(const CellWindow& w) const {
  const MapGrid& whole = parts_->grid;
  refuse_outside(whole, w);
  Raster raster{cut(whole, w), {}};
  require_room(w.columns, w.rows, sizeof(double), file().string(),
               "Crop it (gdal_translate -projwin), take larger cells (gdalwarp -tr), or give the working grid bounds "
               "(extent_m in [preprocess.grid])");
  raster.values.resize(raster.grid.count());
  if (raster.values.empty()) return raster;
  const std::size_t before = parts_->source.undeclared_nodata();
  each_row(w, [&](int row, const double* values) {
    std::copy_n(values, w.columns, raster.values.begin() + static_cast<std::ptrdiff_t>(raster.grid.index(0, row)));
  });
  parts_->warn_of_undeclared(before, parts_->is_whole(w));
  return raster;
}

Raster RasterFile::read_content() const {
  const MapGrid& whole = parts_->grid;
  int west = whole.columns, east = -1, south = whole.rows, north = -1;
  const std::size_t before = parts_->source.undeclared_nodata();
  each_row({0, 0, whole.columns, whole.rows}, [&](int row, const double* values) {
    for (int column = 0; column < whole.columns; ++column) {
      if (std::isnan(values[column]) || values[column] == 0) continue;
      west = std::min(west, column);
      east = std::max(east, column);
      south = std::min(south, row);
      north = std::max(north, row);
    }
  });
  parts_->warn_of_undeclared(before, true);
  if (east < 0) return read();
  west = std::max(west - 1, 0);
  south = std::max(south - 1, 0);
  east = std::min(east + 1, whole.columns - 1);
  north = std::min(north + 1, whole.rows - 1);
  return read({west, south, east - west + 1, north - south + 1});
}

Raster RasterFile::read() const {
  const MapGrid& grid = parts_->grid;
  Raster raster = read({0, 0, grid.columns, grid.rows});
  if (std::all_of(raster.values.begin(), raster.values.end(), [](double value) { return std::isnan(value); }))
    throw DataError({file().string() + ": no cell holds a value",
                     fmt::format("all {} x {} cells are nodata", grid.columns, grid.rows),
                     "Check the file and its nodata value: gdalinfo -stats " + file().string()});
  return raster;
}

Raster read_raster(const fs::path& file) { return RasterFile(file).read(); }

RasterFile raster_in_metres(const fs::path& file, const std::string& crs_wkt) {
  return RasterFile(file, {.to_crs = in_metres(file) ? "" : crs_wkt, .vertical_unit = {}, .or_else = {}});
}

namespace {
const ReadOptions no_lengths{.to_crs = {}, .vertical_unit = {}, .or_else = {}, .are_lengths = false};
}

bool in_metres(const fs::path& file) { return RasterSource(file, no_lengths).in_metres(); }

std::string utm_crs_of(const fs::path& file) {
  const RasterSource source(file, no_lengths);
  if (source.srs() == nullptr || !source.placed())
    throw DataError(
        {file.string() + ": has no CRS", "so its UTM zone cannot be told",
         fmt::format("Give it one: gdal_translate -a_srs EPSG:<code> {} {}", file.string(), mended(file, "_placed"))});
  const auto [x, y] = source.centre();
  const std::string zone = gdal::utm_zone(*source.srs(), x, y);
  OGRSpatialReference srs;
  const QuietErrors errors;
  if (srs.SetFromUserInput(zone.c_str()) != OGRERR_NONE)
    throw DataError({fmt::format("{}: its centre, {:.6g}, {:.6g} in {}, lies in no UTM zone", file.string(), x, y,
                                 gdal::short_name(*source.srs())),
                     "these reach from 80 degrees south to 84 north", "Check its CRS, or name a CRS in metres"});
  return gdal::horizontal_wkt(&srs);
}

std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name) {
  gdal::require_local(file);
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset)
    throw DataError(
        {file.string() + ": not a raster that can be read", errors.text(), "Look at it: gdalinfo " + file.string()});
  const char* text = dataset->GetMetadataItem(name.c_str());
  if (text == nullptr || CPLGetValueType(text) == CPL_VALUE_STRING) return std::nullopt;
  return CPLAtof(text);
}

}  // namespace talus
