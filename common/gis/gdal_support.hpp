// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every file that calls GDAL shares: start-up, quiet errors, handles, coordinate systems. Nobody else includes it.
#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/map/raster.hpp"

namespace talus {
struct RasterTags;  // of geotiff.hpp
}  // namespace talus

namespace talus::gdal {

/// Starts GDAL on first use, and while it lives keeps GDAL's errors off stderr and collects them instead.
class QuietErrors {
 public:
  QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  ~QuietErrors();
  bool failed() const { return !failures_.empty(); }  ///< some call failed, also one that returns nothing (GDALClose)
  std::string text() const;                           ///< the first failures, joined; "GDAL gave no reason" if none

 private:
  static void CPL_STDCALL collect(CPLErr kind, CPLErrorNum number, const char* message);
  std::vector<std::string> failures_;
};

/// For GDAL's long calls, as their progress function: they end, as failed, once a signal has come.
int CPL_STDCALL go_on_unless_interrupted(double share, const char* message, void* data);

/// Closes a dataset of GDAL when its owner goes.
struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Opens an ASCII grid, in double precision: GDAL would keep seven digits, and 2345.678 m have as many; and where it is
/// not told the type, it looks through all cells for it and never ends that where a reading fails. `how`: GDAL_OF_...
Dataset open_ascii_grid(const std::string& path, unsigned how);

/// Destroys a transformation of OGR when its owner goes.
struct DestroyTransformation {
  void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using Transformation = std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>;

/// A CRS from WKT, x before y. Throws DataError when PROJ does not understand it.
OGRSpatialReference spatial_reference(const std::string& wkt);

/// A CRS without its vertical axis.
OGRSpatialReference horizontal(const OGRSpatialReference& srs);

/// WKT2 of the horizontal part of a CRS (heights are metres in all of this project); "" for none.
std::string horizontal_wkt(const OGRSpatialReference* srs);

/// Whether a CRS (null: none) says nothing of places: it is empty, vertical alone, or local coordinates in metres,
/// which are anybody's.
bool places_nothing(const OGRSpatialReference* srs);

/// Short name for messages: "EPSG:32149", else the CRS's own name.
std::string short_name(const OGRSpatialReference& srs);

/// The transformation from one CRS to another. Throws DataError, which names `what` is moved, when there is no way
/// between them.
Transformation transformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                              const std::string& what = "a file");

/// "EPSG:32611", the UTM zone of a point given in `srs`; "EPSG:<a metric one>" when it cannot be told.
std::string utm_zone(const OGRSpatialReference& srs, double x, double y);

/// The fault of a file that GDAL does not open as `wanted`: what it is where its first bytes tell, with the command
/// that makes something readable of it, else GDAL's reason and the `tool` that looks at it.
Fault no_dataset(const std::filesystem::path& file, const std::string& wanted, const std::string& reason,
                 const std::string& tool);

/// Gives a dataset the place and the CRS of a grid.
void place(GDALDataset& dataset, const MapGrid& grid);

/// Gives a dataset of one band its description, its unit and its metadata.
void describe(GDALDataset& dataset, const RasterTags& tags);

/// The raster as a GDAL dataset in memory: Float64, north first, NaN as `missing`.
Dataset in_memory(const Raster& raster, double missing);

}  // namespace talus::gdal
