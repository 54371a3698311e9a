// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "common/gis/geotiff.hpp"

namespace talus {

/// A GeoTIFF written block by block, for rasters larger than memory: tiled, 32-bit floats, deflate, nodata -9999, with
/// overviews from 2048 cells on. A sparse one holds only the tiles that are written, and its overviews are written by
/// the caller. Written aside and renamed by finish(). Every failure (disk full) is a DataError.
class RasterWriter {
 public:
  enum class Tiles { all, sparse };
  RasterWriter(const std::filesystem::path& file, const MapGrid& grid, const RasterTags& tags,
               Tiles tiles = Tiles::all);
  ~RasterWriter();
  /// A part of the grid: its cells are the grid's.
  void write(const Raster& part);
  /// Of a sparse one, how many overviews it has.
  int overviews() const;
  /// The grid of an overview, from 0: cells twice as wide as those of the one before, or of the grid itself, counted
  /// from the north-west corner.
  MapGrid overview_grid(int overview) const;
  /// A part of an overview: its cells are the overview's.
  void write_overview(int overview, const Raster& part);
  /// Sets a metadata item, also one known only at the end.
  void set_item(const std::string& name, const std::string& value);
  /// Closes the file, with overviews where it is large, and gives it its name. Throws DataError.
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace talus
