// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters written as GeoTIFF, whole or row by row, aside and renamed.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// What cells without a value hold in the GeoTIFFs that are written.
inline constexpr float nodata = -9999;

/// What a GeoTIFF says of itself beside its values.
struct RasterTags {
  std::string description;  ///< band description: "deposit thickness, vertical [m]"
  std::string unit;         ///< "m"
  std::vector<std::pair<std::string, std::string>> metadata;
};

/// Write a cloud-optimised GeoTIFF (COG driver, deflate, overviews, nodata -9999, Float64 so that volumes close to
/// 1e-9), aside and renamed. Throws DataError when anything fails on the way (disk full).
void write_cog(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

/// Write a plain GeoTIFF (not COG) by the same conventions, for samples and intermediates. Throws likewise.
void write_geotiff(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

/// A GeoTIFF written block by block, for rasters larger than memory: tiled, 32-bit floats, deflate, nodata -9999, with
/// overviews from 2048 cells on. A sparse one holds only the tiles that are written, and its overviews are written by
/// the caller. Written aside and renamed by finish(). Every failure (disk full) is a DataError.
class RasterWriter {
 public:
  enum class Tiles { all, sparse };
  RasterWriter(const std::filesystem::path& file, const MapGrid& grid, const RasterTags& tags,
               Tiles tiles = Tiles::all);
  ~RasterWriter();
  void write(const Raster& part);  ///< a part of the grid: its cells are the grid's
  int overviews() const;           ///< of a sparse one, how many overviews it has
  /// The grid of an overview, from 0: cells twice as wide as those of the one before, or of the grid itself, counted
  /// from the north-west corner.
  MapGrid overview_grid(int overview) const;
  void write_overview(int overview, const Raster& part);  ///< a part of an overview: its cells are the overview's
  /// Sets a metadata item, also one known only at the end.
  void set_item(const std::string& name, const std::string& value);
  /// Closes the file, with overviews where it is large, and gives it its name. Throws DataError.
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace talus
