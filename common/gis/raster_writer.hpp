#pragma once

#include <filesystem>
#include <memory>

#include "common/gis/geotiff.hpp"

namespace talus {

/// A GeoTIFF written block by block, for rasters larger than memory: tiled, 32-bit floats, deflate, nodata -9999, with
/// overviews from 2048 cells on. Written aside and renamed by finish(). Every failure (disk full) is a DataError.
class RasterWriter {
 public:
  RasterWriter(const std::filesystem::path& file, const MapGrid& grid, const RasterTags& tags);
  ~RasterWriter();
  /// A part of the grid: its cells are the grid's.
  void write(const Raster& part);
  /// Metadata known only at the end.
  void say(const std::string& name, const std::string& value);
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace talus
