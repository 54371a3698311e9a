// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/gdal_support.hpp"

#include "common/gis/geotiff.hpp"
#include "common/gis/local_only.hpp"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <mutex>

#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"
#include "common/text_encoding.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)  // clang's word
#define TALUS_LEAKS_ARE_LOOKED_FOR
#endif
#elif defined(__SANITIZE_ADDRESS__)  // GCC's
#define TALUS_LEAKS_ARE_LOOKED_FOR
#endif
#ifdef TALUS_LEAKS_ARE_LOOKED_FOR
#include <sanitizer/lsan_interface.h>
#endif

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

/// In a bundle the data of PROJ and GDAL lie beside the program, and the system's, if any, belong to other versions.
void use_bundled_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return;
  const fs::path share = program.parent_path().parent_path() / "share";
  const std::string proj = (share / "proj").string();
  const std::string data = (share / "gdal").string();
  if (fs::is_directory(proj, error)) {
    ::setenv("PROJ_LIB", proj.c_str(), 1);
    ::setenv("PROJ_DATA", proj.c_str(), 1);
    const std::array<const char*, 2> paths{proj.c_str(), nullptr};
    OSRSetPROJSearchPaths(paths.data());
  }
  if (fs::is_directory(data, error)) {
    ::setenv("GDAL_DATA", data.c_str(), 1);
    CPLSetConfigOption("GDAL_DATA", data.c_str());
  }
}

void start() {
  static std::once_flag once;
  std::call_once(once, [] {
    use_bundled_data();
#ifdef TALUS_LEAKS_ARE_LOOKED_FOR
    const __lsan::ScopedDisabler what_gdal_never_frees;  // its file systems, once others stand in their place
#endif
    GDALAllRegister();
    close_the_network();
    // GDAL would keep a twentieth of all memory of cells it has read; large rasters are read here once, by windows.
    if (CPLGetConfigOption("GDAL_CACHEMAX", nullptr) == nullptr) GDALSetCacheMax64(GIntBig{128} << 20);
  });
}

}  // namespace

int CPL_STDCALL go_on_unless_interrupted(double, const char*, void*) { return interrupted() ? FALSE : TRUE; }

QuietErrors::QuietErrors() {
  start();
  CPLPushErrorHandlerEx(collect, this);
  CPLErrorReset();
}

QuietErrors::~QuietErrors() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

void QuietErrors::collect(CPLErr kind, CPLErrorNum, const char* message) {
  auto* self = static_cast<QuietErrors*>(CPLGetErrorHandlerUserData());
  if (kind == CE_Failure || kind == CE_Fatal) self->failures_.emplace_back(message);
}

std::string QuietErrors::text() const {
  if (failures_.empty()) return "GDAL gave no reason";
  std::string text = failures_.front();
  for (std::size_t i = 1; i < failures_.size() && i < 3; ++i)
    if (failures_[i] != failures_[i - 1]) text += "; " + failures_[i];
  return text;
}

OGRSpatialReference spatial_reference(const std::string& wkt) {
  OGRSpatialReference srs;
  if (srs.importFromWkt(wkt.c_str()) != OGRERR_NONE)
    throw DataError({"a coordinate reference system is not understood", wkt.substr(0, 80),
                     "Give the file a CRS: gdal_translate -a_srs EPSG:<code> in.tif out.tif"});
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return srs;
}

bool places_nothing(const OGRSpatialReference* srs) {
  if (srs == nullptr || srs->IsEmpty()) return true;
  const bool is_local = srs->IsLocal() != 0 && std::abs(srs->GetLinearUnits() - 1) <= 1e-9;
  return is_local || (srs->IsVertical() != 0 && srs->IsCompound() == 0);
}

OGRSpatialReference horizontal(const OGRSpatialReference& srs) {
  OGRSpatialReference result(srs);
  result.StripVertical();
  if (result.GetAxesCount() > 2) result.DemoteTo2D(nullptr);
  return result;
}

std::string horizontal_wkt(const OGRSpatialReference* srs) {
  if (places_nothing(srs)) return "";
  const OGRSpatialReference flat = horizontal(*srs);
  const std::array<const char*, 3> options{"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* wkt = nullptr;
  const bool exported = flat.exportToWkt(&wkt, options.data()) == OGRERR_NONE;
  std::string text = exported && wkt != nullptr ? as_utf8(wkt) : "";
  CPLFree(wkt);
  return text;
}

std::string short_name(const OGRSpatialReference& srs) {
  const char* authority = srs.GetAuthorityName(nullptr);
  const char* code = srs.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) return fmt::format("{}:{}", authority, code);
  const char* name = srs.GetName();
  return name != nullptr && *name != '\0' ? as_utf8(name) : "an unnamed CRS";
}

Transformation transformation(const OGRSpatialReference& from, const OGRSpatialReference& to, const std::string& what) {
  const QuietErrors errors;
  Transformation result(OGRCreateCoordinateTransformation(&from, &to));
  if (!result)
    throw DataError({fmt::format("{}: no transformation from {} to {}", what, short_name(from), short_name(to)),
                     errors.text().substr(0, 120),
                     "One of them is not the CRS of these coordinates, or is not known well enough: name the right one "
                     "(gdal_edit.py -a_srs EPSG:<code> for a raster, ogr2ogr -a_srs for shapes)"});
  return result;
}

std::string utm_zone(const OGRSpatialReference& srs, double x, double y) {
  const QuietErrors errors;
  OGRSpatialReference geographic;
  geographic.SetWellKnownGeogCS("WGS84");
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference from(srs);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const Transformation t(OGRCreateCoordinateTransformation(&from, &geographic));
  bool known = t && t->Transform(1, &x, &y);
  if (x > 180 && x <= 360) x -= 360;  // some count 0..360 degrees
  known = known && std::abs(x) <= 180 && y >= -80 && y <= 84;
  if (!known) return "EPSG:<a metric one>";
  int zone = std::min(60, static_cast<int>(std::floor((x + 180) / 6)) + 1);
  if (zone == 31 && x >= 3 && y >= 56 && y < 64) zone = 32;  // western Norway lies in 32 by agreement
  return fmt::format("EPSG:{}", (y < 0 ? 32700 : 32600) + zone);
}

Fault no_dataset(const fs::path& file, const std::string& wanted, const std::string& reason, const std::string& tool) {
  const std::string name = file.string(), start = start_of(file, 4);
  if (start.starts_with("LASF"))
    return {name + ": a point cloud (LAS or LAZ)", wanted + " is wanted",
            fmt::format("Make a raster of its ground points: pdal translate {} {} filters.range "
                        "--filters.range.limits=\"Classification[2:2]\" --writers.gdal.resolution=1 "
                        "--writers.gdal.output_type=mean",
                        name, fs::path(file).replace_extension(".tif").string())};
  if (start.starts_with("PK\x03\x04"))
    return {name + ": a ZIP archive", wanted + " is wanted",
            fmt::format("Unpack it and name what lies in it: unzip {}", name)};
  if (start.starts_with("\x1f\x8b"))
    return {name + ": packed by gzip", wanted + " is wanted",
            fmt::format("Unpack it (gunzip -k {}) and name {}", name, fs::path(file).replace_extension("").string())};
  return {name + ": not " + wanted + " that can be read", reason, fmt::format("Look at it: {} {}", tool, name)};
}

void place(GDALDataset& dataset, const MapGrid& grid) {
  std::array<double, 6> corner{grid.west, grid.cell, 0, grid.north(), 0, -grid.cell};
  dataset.SetGeoTransform(corner.data());
  if (grid.crs_wkt.empty()) return;
  const OGRSpatialReference srs = spatial_reference(grid.crs_wkt);
  dataset.SetSpatialRef(&srs);
}

void describe(GDALDataset& dataset, const RasterTags& tags) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  band.SetDescription(tags.description.c_str());
  band.SetUnitType(tags.unit.c_str());
  dataset.SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_AREA);
  for (const auto& [name, value] : tags.metadata) dataset.SetMetadataItem(name.c_str(), value.c_str());
}

Dataset in_memory(const Raster& raster, double missing) {
  const QuietErrors errors;
  const MapGrid& grid = raster.grid;
  auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  Dataset dataset(driver->Create("", grid.columns, grid.rows, 1, GDT_Float64, nullptr));
  if (!dataset)
    throw DataError(
        {fmt::format("a raster of {} x {} cells", grid.columns, grid.rows), errors.text(), "Take a larger spacing"});
  place(*dataset, grid);
  auto* band = dataset->GetRasterBand(1);
  band->SetNoDataValue(missing);
  std::vector<double> line(static_cast<std::size_t>(grid.columns));
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double value = raster.at(column, row);
      line[static_cast<std::size_t>(column)] = std::isnan(value) ? missing : value;
    }
    const int line_from_north = grid.rows - 1 - row;
    if (band->RasterIO(GF_Write, 0, line_from_north, grid.columns, 1, line.data(), grid.columns, 1, GDT_Float64, 0, 0,
                       nullptr) != CE_None)
      throw DataError({"a raster cannot be copied in memory", errors.text(), "Take a larger spacing"});
  }
  return dataset;
}

Dataset open_ascii_grid(const std::string& path, unsigned how) {
  const std::array<const char*, 2> drivers{"AAIGrid", nullptr}, options{"DATATYPE=Float64", nullptr};
  return Dataset(GDALDataset::Open(path.c_str(), how, drivers.data(), options.data()));
}

}  // namespace talus::gdal
