// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/geotiff.hpp"

#include <cpl_string.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "common/gis/gdal_support.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

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

/// The side of the tiles [cells]: a small map is one tile, and no more of it than there is. The driver's 512 cells take
/// four times as long to compress where a map has 200.
int tile_side(const MapGrid& grid) {
  constexpr int least = 128, most = 512, unit = 16;  // of the format: multiples of 16
  const int side = std::max(grid.columns, grid.rows);
  return std::clamp((side + unit - 1) / unit * unit, least, most);
}

}  // namespace

void write_cog(const fs::path& file, const Raster& raster, const RasterTags& tags) {
  CPLStringList options;
  options.SetNameValue("BLOCKSIZE", std::to_string(tile_side(raster.grid)).c_str());
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "YES");
  options.SetNameValue("OVERVIEWS", "AUTO");
  options.SetNameValue("OVERVIEW_RESAMPLING", "AVERAGE");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  write(file, raster, tags, "COG", options);
}

void write_geotiff(const fs::path& file, const Raster& raster, const RasterTags& tags) {
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  write(file, raster, tags, "GTiff", options);
}

}  // namespace talus
