// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/raster_writer.hpp"

#include <cpl_string.h>

#include <cmath>
#include <vector>

#include "common/gis/gdal_support.hpp"
#include "common/gis/geotiff.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace {

constexpr int large = 2048;  // cells from which a map is looked at through overviews

CPLStringList creation_options(RasterWriter::Tiles tiles) {
  CPLStringList options;
  for (const auto& [name, value] : {std::pair{"TILED", "YES"},
                                    {"BLOCKXSIZE", "256"},
                                    {"BLOCKYSIZE", "256"},
                                    {"COMPRESS", "DEFLATE"},
                                    {"PREDICTOR", "3"},
                                    {"ZLEVEL", "1"},
                                    {"BIGTIFF", "IF_SAFER"}})
    options.SetNameValue(name, value);
  if (tiles == RasterWriter::Tiles::sparse) options.SetNameValue("SPARSE_OK", "TRUE");
  options.SetNameValue("NUM_THREADS", std::to_string(thread_limit()).c_str());
  return options;
}

}  // namespace

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
  for (int row = 0; row < g.rows; ++row) {
    for (int c = 0; c < g.columns; ++c) {
      const double value = part.at(c, row);
      values[g.index(c, g.rows - 1 - row)] = std::isnan(value) ? nodata : static_cast<float>(value);
    }
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
