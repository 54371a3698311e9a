// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines as a GeoPackage, through OGR. Made in memory and written as bytes: SQLite on a full disk would leave its
// journal beside a broken file.
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <atomic>

#include "common/gis/gdal_support.hpp"
#include "common/gis/outlines.hpp"
#include "common/gis/vector_layer.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// A file of GDAL's in memory, gone with this.
class MemoryFile {
 public:
  MemoryFile() {
    static std::atomic<int> count{0};
    path_ = fmt::format("/vsimem/outlines-{}.gpkg", ++count);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { VSIUnlink(path_.c_str()); }
  const char* path() const { return path_.c_str(); }
  std::string bytes() const {
    vsi_l_offset size = 0;
    const GByte* data = VSIGetMemFileBuffer(path_.c_str(), &size, FALSE);
    return data == nullptr ? "" : std::string(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
  }

 private:
  std::string path_;
};

/// The names of all numbers in a layer, each once, in the order they come.
std::vector<std::string> number_names(const OutlineLayer& layer) {
  std::vector<std::string> names;
  for (const auto& feature : layer.features) {
    for (const auto& [name, unused] : feature.numbers)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool add_field(OGRLayer& layer, const std::string& name, OGRFieldType type) {
  OGRFieldDefn field(name.c_str(), type);
  return layer.CreateField(&field) == OGRERR_NONE;
}

bool add_feature(OGRLayer& layer, const OutlineFeature& outline) {
  if (outline.polygons.empty()) return true;
  OGRMultiPolygon shape;
  for (const auto& polygon : outline.polygons) {
    const OGRPolygon part = gdal::ogr_polygon(polygon);
    shape.addGeometry(&part);
  }
  OGRFeature feature(layer.GetLayerDefn());
  feature.SetField("name", outline.name.c_str());
  feature.SetField("area_m2", shape.get_Area());
  for (const auto& [name, value] : outline.numbers) feature.SetField(name.c_str(), value);
  return feature.SetGeometry(&shape) == OGRERR_NONE && layer.CreateFeature(&feature) == OGRERR_NONE;
}

/// The CRS; local coordinates by the name that the GeoPackage standard has for them (srs_id -1). None at all would be
/// written as geographic.
OGRSpatialReference reference(const std::string& crs_wkt) {
  if (!crs_wkt.empty()) return gdal::spatial_reference(crs_wkt);
  OGRSpatialReference local;
  local.SetLocalCS("Undefined Cartesian SRS");
  return local;
}

bool add_layer(GDALDataset& dataset, const OGRSpatialReference& srs, const OutlineLayer& outlines) {
  OGRSpatialReference own(srs);
  OGRLayer* layer = dataset.CreateLayer(outlines.name.c_str(), &own, wkbMultiPolygon);
  if (layer == nullptr) return false;
  bool good = add_field(*layer, "name", OFTString) && add_field(*layer, "area_m2", OFTReal);
  for (const auto& name : number_names(outlines)) good = good && add_field(*layer, name, OFTReal);
  for (const auto& feature : outlines.features) good = good && add_feature(*layer, feature);
  return good;
}

}  // namespace

void write_outlines(const fs::path& gpkg, const std::string& crs_wkt, const std::vector<OutlineLayer>& layers) {
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = reference(crs_wkt);
  const MemoryFile file;
  auto* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr)
    throw DataError(
        {gpkg.string() + ": cannot be written", "this GDAL has no GPKG driver", "Install GDAL with SQLite"});
  gdal::Dataset dataset(driver->Create(file.path(), 0, 0, 0, GDT_Unknown, nullptr));
  bool good = dataset != nullptr;
  for (const auto& layer : layers) good = good && add_layer(*dataset, srs, layer);
  dataset.reset();  // closing writes what is left, and reports through `errors` alone
  if (!good || errors.failed()) throw DataError(write_fault(gpkg, errors.text()));
  write_text(gpkg, file.bytes());
}

}  // namespace talus
