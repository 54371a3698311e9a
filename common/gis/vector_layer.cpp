// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/vector_layer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/stage/crash_report.hpp"

namespace talus::gdal {
namespace fs = std::filesystem;

Dataset open_vector(const fs::path& file) {
  require_local(file);
  const WhileReading reading(file, "Copy or download it again");
  const QuietErrors errors;
  Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset && dataset->GetLayerCount() > 0) return dataset;
  const bool plain = file.is_absolute() && !file.string().starts_with("/vsi");
  if (!dataset && plain && !fs::exists(file))
    throw DataError({file.string() + ": no such file", "", "Check the path in the recipe"});
  throw DataError({file.string() + ": not a vector file that can be read", dataset ? "no layer in it" : errors.text(),
                   "Look at it: ogrinfo " + file.string()});
}

OGRLayer& layer_named(GDALDataset& dataset, const fs::path& file, const std::string& name) {
  if (name.empty()) return *dataset.GetLayer(0);
  if (OGRLayer* named = dataset.GetLayerByName(name.c_str())) return *named;
  std::vector<std::string> there;
  for (auto* layer : dataset.GetLayers()) there.emplace_back(layer->GetName());
  throw DataError({fmt::format("{}: no layer \"{}\" in it", file.string(), name),
                   fmt::format("it has {}", fmt::join(there, ", ")), "Name one that is there"});
}

void choose_features(OGRLayer& layer, const fs::path& file, const std::string& where, const QuietErrors& errors) {
  if (where.empty()) return;
  if (layer.SetAttributeFilter(where.c_str()) == OGRERR_NONE && !errors.failed()) return;
  throw DataError({fmt::format("{}: the condition {} cannot be understood", file.string(), where), errors.text(),
                   "Write it with the names of attributes: id = 12, or state = 'active'; ogrinfo -so lists them"});
}

std::string condition_words(const LayerChoice& choice) {
  return choice.where.empty() ? "" : fmt::format(" whose attributes meet {}", choice.where);
}

Transformation transformation_to(OGRLayer& layer, const std::string& crs_wkt) {
  const OGRSpatialReference* own = layer.GetSpatialRef();
  if (crs_wkt.empty() || own == nullptr || own->IsEmpty() || own->IsLocal() != 0) return nullptr;
  OGRSpatialReference from(*own);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return transformation(from, spatial_reference(crs_wkt));
}

void carry(const fs::path& file, OGRCoordinateTransformation* transform, OGRGeometry& shape,
           const QuietErrors& errors) {
  if (transform == nullptr || shape.transform(transform) == OGRERR_NONE) return;
  const char* what = wkbFlatten(shape.getGeometryType()) == wkbPolygon ? "a polygon" : "a shape";
  throw DataError(
      {fmt::format("{}: {} cannot be brought to the working CRS", file.string(), what), errors.text(),
       "Its coordinates do not fit its CRS. Name the true one: ogr2ogr -a_srs EPSG:<code> out.gpkg " + file.string()});
}

void require_whole(const fs::path& file, const QuietErrors& errors) {
  if (errors.failed())
    throw DataError(
        {file.string() + ": cannot be read to its end", errors.text(), "Look at it: ogrinfo -al " + file.string()});
}

bool is_numeric(const OGRFeature& feature, int field) {
  const OGRFieldType type = feature.GetFieldDefnRef(field)->GetType();
  return type == OFTInteger || type == OFTInteger64 || type == OFTReal ||
         (type == OFTString && CPLGetValueType(feature.GetFieldAsString(field)) != CPL_VALUE_STRING);
}

std::vector<FeatureValue> values_of(const OGRFeature& feature) {
  std::vector<FeatureValue> values;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    FeatureValue value{.name = feature.GetFieldDefnRef(i)->GetNameRef(), .number = {}, .text = {}};
    value.is_null = !feature.IsFieldSetAndNotNull(i);
    if (!value.is_null) value.text = feature.GetFieldAsString(i);
    if (!value.is_null && is_numeric(feature, i)) value.number = feature.GetFieldAsDouble(i);
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace talus::gdal
