// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/geotiff.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <cpl_string.h>

#include "common/gis/gdal_support.hpp"
#include "common/stage/files.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// True when the file holds the very bytes of `expected`. A full disk or a lost mount shows here at the latest.
bool reads_back(const fs::path& written, GDALDataset& expected) {
  const gdal::Dataset dataset(GDALDataset::Open(written.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset) return false;
  const int columns = expected.GetRasterXSize(), rows = expected.GetRasterYSize();
  std::vector<double> ours(static_cast<std::size_t>(columns)), theirs(ours.size());
  const auto line_of = [&](GDALDataset& from, int line, std::vector<double>& values) {
    return from.GetRasterBand(1)->RasterIO(GF_Read, 0, line, columns, 1, values.data(), columns, 1, GDT_Float64, 0, 0,
                                           nullptr) == CE_None;
  };
  for (int line = 0; line < rows; ++line) {
    if (!line_of(expected, line, ours) || !line_of(*dataset, line, theirs)) return false;
    if (std::memcmp(ours.data(), theirs.data(), ours.size() * sizeof(double)) != 0) return false;
  }
  return true;
}

void write(const fs::path& file, const Raster& raster, const RasterTags& tags, const char* driver_name,
           const CPLStringList& options) {
  PendingFile pending(file);
  const gdal::QuietErrors errors;
  const gdal::Dataset source = gdal::in_memory(raster, nodata);
  gdal::describe(*source, tags);
  auto* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
  if (driver == nullptr)
    throw DataError({file.string() + ": cannot be written", std::string("this GDAL has no ") + driver_name + " driver",
                     "Install GDAL 3.1 or newer"});
  gdal::Dataset written(driver->CreateCopy(pending.path().c_str(), source.get(), TRUE,
                                           const_cast<char**>(options.List()), gdal::go_on_unless_interrupted,
                                           nullptr));
  const bool made = written != nullptr;
  written.reset();  // closing flushes, and reports through `errors` alone
  stop_if_interrupted("writing " + file.string());
  if (!made || errors.failed()) throw DataError(write_fault(file, errors.text()));
  if (!reads_back(pending.path(), *source)) throw DataError(write_fault(file, "it does not read back as written"));
  pending.commit();
}

/// A list of GDAL's options.
CPLStringList list_of(std::initializer_list<std::string> words) {
  CPLStringList list;
  for (const std::string& word : words) list.AddString(word.c_str());
  return list;
}

/// The side of the tiles [cells]: a small map is one tile, and no more of it than there is. The driver's 512 cells take
/// four times as long to compress where a map has 200.
int tile_side(const MapGrid& grid) {
  constexpr int least = 128, most = 512, unit = 16;  // of the format: multiples of 16
  const int side = std::max(grid.columns, grid.rows);
  return std::clamp((side + unit - 1) / unit * unit, least, most);
}

constexpr int large = 2048;  // cells from which a map is looked at through overviews

CPLStringList creation_options(RasterWriter::Tiles tiles) {
  auto options = list_of({"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256", "COMPRESS=DEFLATE", "PREDICTOR=3",
                          "ZLEVEL=1", "BIGTIFF=IF_SAFER", "NUM_THREADS=" + std::to_string(thread_limit())});
  if (tiles == RasterWriter::Tiles::sparse) options.AddString("SPARSE_OK=TRUE");
  return options;
}

}  // namespace

void write_cog(const fs::path& file, const Raster& raster, const RasterTags& tags) {
  write(file, raster, tags, "COG",
        list_of({"BLOCKSIZE=" + std::to_string(tile_side(raster.grid)), "COMPRESS=DEFLATE", "PREDICTOR=YES",
                 "OVERVIEWS=AUTO", "OVERVIEW_RESAMPLING=AVERAGE", "BIGTIFF=IF_SAFER"}));
}

void write_geotiff(const fs::path& file, const Raster& raster, const RasterTags& tags) {
  write(file, raster, tags, "GTiff", list_of({"COMPRESS=DEFLATE", "PREDICTOR=3", "BIGTIFF=IF_SAFER"}));
}

struct RasterWriter::Open {
  PendingFile pending;
  MapGrid grid;
  gdal::Dataset dataset;
  Tiles tiles = Tiles::all;

  std::vector<int> factors() const {
    std::vector<int> factors;
    if (std::max(grid.columns, grid.rows) < large) return factors;
    for (int f = 2; std::max(grid.columns, grid.rows) / f >= 256; f *= 2) factors.push_back(f);
    return factors;
  }
  /// Empty overviews of a sparse file.
  void make_room(const gdal::QuietErrors& errors) {
    std::vector<int> all = factors();
    if (all.empty()) return;
    const CPLConfigOptionSetter sparse("SPARSE_OK_OVERVIEW", "YES", false);
    if (dataset->BuildOverviews("NONE", static_cast<int>(all.size()), all.data(), 0, nullptr, nullptr, nullptr) !=
        CE_None)
      fail(errors);
  }
  void write(GDALRasterBand& band, const MapGrid& whole, const Raster& part) const;

  [[noreturn]] void fail(const gdal::QuietErrors& errors) const {
    throw DataError(write_fault(pending.final_path(), errors.text()));
  }
};

RasterWriter::RasterWriter(const std::filesystem::path& file, const MapGrid& grid, const RasterTags& tags, Tiles tiles)
    : open_(new Open{PendingFile(file), grid, nullptr, tiles}) {
  const gdal::QuietErrors errors;
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const CPLStringList options = creation_options(tiles);
  open_->dataset.reset(driver->Create(open_->pending.path().c_str(), grid.columns, grid.rows, 1, GDT_Float32,
                                      const_cast<char**>(options.List())));
  if (!open_->dataset) open_->fail(errors);
  gdal::place(*open_->dataset, grid);
  open_->dataset->GetRasterBand(1)->SetNoDataValue(nodata);
  gdal::describe(*open_->dataset, tags);
  if (tiles == Tiles::sparse) open_->make_room(errors);
}

RasterWriter::~RasterWriter() = default;

void RasterWriter::set_item(const std::string& name, const std::string& value) {
  open_->dataset->SetMetadataItem(name.c_str(), value.c_str());
}

void RasterWriter::Open::write(GDALRasterBand& band, const MapGrid& whole, const Raster& part) const {
  const gdal::QuietErrors errors;
  const MapGrid& g = part.grid;
  const int column = static_cast<int>(std::lround((g.west - whole.west) / g.cell));
  const int line = static_cast<int>(std::lround((whole.north() - g.north()) / g.cell));
  std::vector<float> values(g.count());
  for (int row = 0; row < g.rows; ++row)
    for (int c = 0; c < g.columns; ++c) {
      const double value = part.at(c, row);
      values[g.index(c, g.rows - 1 - row)] = std::isnan(value) ? nodata : static_cast<float>(value);
    }
  if (band.RasterIO(GF_Write, column, line, g.columns, g.rows, values.data(), g.columns, g.rows, GDT_Float32, 0, 0,
                    nullptr) != CE_None)
    fail(errors);
}

void RasterWriter::write(const Raster& part) { open_->write(*open_->dataset->GetRasterBand(1), open_->grid, part); }

int RasterWriter::overviews() const { return open_->dataset->GetRasterBand(1)->GetOverviewCount(); }

MapGrid RasterWriter::overview_grid(int overview) const {
  const int factor = 2 << overview;
  MapGrid grid = open_->grid;
  grid.cell *= factor;
  grid.columns = (open_->grid.columns + factor - 1) / factor;
  grid.rows = (open_->grid.rows + factor - 1) / factor;
  grid.south = open_->grid.north() - grid.rows * grid.cell;
  return grid;
}

void RasterWriter::write_overview(int overview, const Raster& part) {
  open_->write(*open_->dataset->GetRasterBand(1)->GetOverview(overview), overview_grid(overview), part);
}

void RasterWriter::finish() {
  const gdal::QuietErrors errors;
  if (std::vector<int> factors = open_->factors(); open_->tiles == Tiles::all && !factors.empty()) {
    if (open_->dataset->BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0, nullptr,
                                       gdal::go_on_unless_interrupted, nullptr) != CE_None) {
      stop_if_interrupted("writing " + open_->pending.final_path().string());
      open_->fail(errors);
    }
  }
  open_->dataset.reset();  // closing flushes, and reports through `errors` alone
  if (errors.failed()) open_->fail(errors);
  open_->pending.commit();
}

}  // namespace talus
