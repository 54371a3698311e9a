// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reprojection by GDAL's warper, lazily: only what is asked for is read and computed.
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

#include "common/gis/gdal_support.hpp"
#include "common/gis/raster_source.hpp"

namespace talus::gdal {
namespace {

/// A source's cells for the warper, which knows nodata but neither units nor undeclared nodata. Exceptions wait here
/// until GDAL has returned.
class PlainCells final : public GDALDataset {
 public:
  explicit PlainCells(RasterSource& source);

  const OGRSpatialReference* GetSpatialRef() const override { return &srs_; }
  CPLErr GetGeoTransform(double* g) override {
    std::copy(transform_.begin(), transform_.end(), g);
    return CE_None;
  }
  std::exception_ptr take_fault() { return std::exchange(fault_, nullptr); }

 private:
  friend class PlainBand;
  RasterSource& source_;
  OGRSpatialReference srs_;
  GeoTransform transform_;
  std::exception_ptr fault_;
};

class PlainBand final : public GDALRasterBand {
 public:
  PlainBand(PlainCells* cells, std::array<int, 2> block) {
    poDS = cells;
    nBand = 1;
    eDataType = GDT_Float64;
    nBlockXSize = std::min(block[0], cells->GetRasterXSize());
    nBlockYSize = std::min(block[1], cells->GetRasterYSize());
  }
  double GetNoDataValue(int* declared) override {
    if (declared != nullptr) *declared = 1;
    return std::nan("");
  }

 protected:
  CPLErr IReadBlock(int block_column, int block_line, void* data) override {
    auto& cells = *static_cast<PlainCells*>(poDS);
    const int column = block_column * nBlockXSize, line = block_line * nBlockYSize;
    const int columns = std::min(nBlockXSize, nRasterXSize - column),
              lines = std::min(nBlockYSize, nRasterYSize - line);
    try {
      const std::vector<double> values = cells.source_.read(column, line, columns, lines);
      const auto width = static_cast<std::size_t>(columns);
      for (std::size_t l = 0; l < static_cast<std::size_t>(lines); ++l)
        std::memcpy(static_cast<double*>(data) + l * static_cast<std::size_t>(nBlockXSize), values.data() + l * width,
                    width * sizeof(double));
      return CE_None;
    } catch (...) {
      cells.fault_ = std::current_exception();
      CPLError(CE_Failure, CPLE_FileIO, "cells cannot be read");
      return CE_Failure;
    }
  }
};

PlainCells::PlainCells(RasterSource& source) : source_(source), srs_(*source.srs()), transform_(source.transform()) {
  nRasterXSize = source.columns();
  nRasterYSize = source.lines();
  srs_.StripVertical();  // or GDAL would convert heights on its own
  srs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (srs_.IsGeographic() && transform_[0] >= 180) transform_[0] -= 360;  // 0..360 degrees
  SetBand(1, new PlainBand(this, source.block()));
}

/// To two digits: cells of 26 m rather than 25.73 m, so that two surveys of one place share their cells.
double rounded(double length) {
  const double unit = std::pow(10, std::floor(std::log10(length)) - 1);
  return std::round(length / unit) * unit;
}

[[noreturn]] void refuse(const RasterSource& source, const OGRSpatialReference& srs, const std::string& why) {
  throw DataError({fmt::format("{}: cannot be reprojected from {} to {}", source.file().string(),
                               short_name(*source.srs()), short_name(srs)),
                   why, "Check its coordinates and CRS: gdalinfo " + source.file().string()});
}

/// The side of a square as large as the source's middle cell [m].
double cell_size(const RasterSource& source, const GeoTransform& g, OGRCoordinateTransformation& to) {
  const double c = 0.5 * source.columns(), l = 0.5 * source.lines();
  std::array<double, 3> x{}, y{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double column = c + (i == 1), line = l + (i == 2);
    x[i] = g[0] + g[1] * column + g[2] * line;
    y[i] = g[3] + g[4] * column + g[5] * line;
  }
  to.Transform(3, x.data(), y.data());
  return std::sqrt(std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])));
}

MapGrid grid_around(const RasterSource& source, const PlainCells& cells, const OGRSpatialReference& srs) {
  GeoTransform g{};
  const_cast<PlainCells&>(cells).GetGeoTransform(g.data());
  const Transformation to = transformation(*cells.GetSpatialRef(), srs);
  const double cell = cell_size(source, g, *to);
  const double c = source.columns(), l = source.lines();
  const auto [west, east] = std::minmax({g[0], g[0] + g[1] * c, g[0] + g[2] * l, g[0] + g[1] * c + g[2] * l});
  const auto [south, north] = std::minmax({g[3], g[3] + g[4] * c, g[3] + g[5] * l, g[3] + g[4] * c + g[5] * l});
  std::array<double, 4> bounds{};
  constexpr int edge_points = 21;
  const bool moved =
      to->TransformBounds(west, south, east, north, &bounds[0], &bounds[1], &bounds[2], &bounds[3], edge_points) != 0;
  if (!moved || !(cell > 0) || !std::isfinite(cell)) refuse(source, srs, "its coordinates do not fit its CRS");
  MapGrid grid;
  grid.cell = rounded(cell);
  const double first_column = std::floor(bounds[0] / grid.cell), first_row = std::floor(bounds[1] / grid.cell);
  grid.west = first_column * grid.cell;
  grid.south = first_row * grid.cell;
  grid.columns = static_cast<int>(std::ceil(bounds[2] / grid.cell) - first_column);
  grid.rows = static_cast<int>(std::ceil(bounds[3] / grid.cell) - first_row);
  grid.crs_wkt = horizontal_wkt(&srs);
  return grid;
}

Dataset warp(const RasterSource& source, GDALDataset& cells, const MapGrid& grid, const OGRSpatialReference& srs) {
  CPLStringList words;
  const auto add = [&](std::initializer_list<std::string> arguments) {
    for (const std::string& argument : arguments) words.AddString(argument.c_str());
  };
  const auto number = [](double value) { return fmt::format("{:.17g}", value); };
  add({"-of", "VRT", "-ot", "Float64", "-dstnodata", "nan", "-r", "bilinear"});
  add({"-t_srs", grid.crs_wkt, "-ts", std::to_string(grid.columns), std::to_string(grid.rows)});
  add({"-te", number(grid.west), number(grid.south), number(grid.east()), number(grid.north())});
  // Coordinates to a thousandth of a cell. And the plain bilinear kernel also where cells grow by a tenth: GDAL's wider
  // one, meant for overviews, would put a slope off by hundredths of a cell.
  add({"-et", "0.001", "-wo", "XSCALE=1", "-wo", "YSCALE=1"});
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(words.List(), nullptr);
  GDALDatasetH from = GDALDataset::ToHandle(&cells);
  const QuietErrors errors;
  Dataset warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, options, nullptr)));
  GDALWarpAppOptionsFree(options);
  if (!warped) refuse(source, srs, errors.text());
  return warped;
}

}  // namespace

Warped::Warped(RasterSource& source, const OGRSpatialReference& srs) {
  auto cells = std::make_unique<PlainCells>(source);
  grid_ = grid_around(source, *cells, srs);
  cells_ = Dataset(cells.release());
  warped_ = warp(source, *cells_, grid_, srs);
}

Warped::~Warped() = default;

std::vector<double> Warped::read(int column, int line, int columns, int lines) {
  const QuietErrors errors;
  std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines));
  const bool read = warped_->GetRasterBand(1)->RasterIO(GF_Read, column, line, columns, lines, values.data(), columns,
                                                        lines, GDT_Float64, 0, 0, nullptr) == CE_None;
  if (const auto fault = static_cast<PlainCells&>(*cells_).take_fault()) std::rethrow_exception(fault);
  if (!read || errors.failed())
    throw DataError({"a raster cannot be reprojected", errors.text(), "Reproject it beforehand: gdalwarp -t_srs"});
  return values;
}

}  // namespace talus::gdal
