// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include "common/gis/ascii_grid.hpp"
#include "common/gis/features.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/signals.hpp"
#include "common/text_encoding.hpp"

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

/// XML says its encoding, and its readers go by that.
void refuse_wide_text(const fs::path& file) {
  const std::string start = start_of(file, 64);
  const std::string_view encoding = wide_encoding(start);
  if (encoding.empty() || start.find('<') < 4) return;
  throw DataError({fmt::format("{}: its text is {}", file.string(), encoding), "UTF-8 is wanted",
                   mend_of_encoding(encoding, file.string())});
}

Dataset open_vector(const fs::path& file) {
  require_local(file);
  refuse_wide_text(file);
  const QuietErrors errors;
  Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset && dataset->GetLayerCount() > 0) return dataset;
  const bool plain = file.is_absolute() && !file.string().starts_with("/vsi");
  if (!dataset && plain && !fs::exists(file))
    throw DataError({file.string() + ": no such file", "", "Check the path in the recipe"});
  throw DataError(no_dataset(file, "a vector file", dataset ? "no layer in it" : errors.text(), "ogrinfo"));
}

/// The layer that a source names; where it names none, that called `usual` if there is one, else the first.
OGRLayer* layer_of(GDALDataset& dataset, const VectorSource& source, const std::string& usual) {
  const std::string& name = source.layer.empty() ? usual : source.layer;
  if (OGRLayer* named = name.empty() ? nullptr : dataset.GetLayerByName(name.c_str())) return named;
  std::vector<std::string> there;
  for (auto* layer : dataset.GetLayers()) {
    there.push_back(as_utf8(layer->GetName()));
    if (there.back() == name) return layer;
  }
  if (source.layer.empty()) {
    if (there.size() > 1)
      warn("layers-left-out", fmt::format("{}: layer \"{}\" is read, the first of {}. Say which one is meant: "
                                          "\"FILE|layername=LAYER\" with {}",
                                          source.file.string(), there.front(), there.size(), fmt::join(there, ", ")));
    return dataset.GetLayer(0);
  }
  throw DataError({fmt::format("{}: no layer \"{}\" in it", source.file.string(), name),
                   fmt::format("it has {}", fmt::join(there, ", ")), "Name one that is there"});
}

/// Whether all text of a layer is UTF-8: names of attributes and values.
bool is_all_utf8(OGRLayer& layer) {
  const OGRFeatureDefn& fields = *layer.GetLayerDefn();
  for (int i = 0; i < fields.GetFieldCount(); ++i)
    if (!is_utf8(fields.GetFieldDefn(i)->GetNameRef())) return false;
  for (const auto& feature : layer)
    for (int i = 0; i < fields.GetFieldCount(); ++i)
      if (fields.GetFieldDefn(i)->GetType() == OFTString && !is_utf8(feature->GetFieldAsString(i))) return false;
  return true;
}

/// A condition with the bytes of the layer's text, to which OGR compares it.
std::string as_in(OGRLayer& layer, const std::string& where) {
  const bool ascii = std::ranges::all_of(where, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  return ascii || is_all_utf8(layer) ? where : as_cp1252(where);
}

/// The way from a layer's CRS to another; none where one of them is not named.
Transformation transformation_to(OGRLayer& layer, const std::string& crs_wkt, const fs::path& file) {
  const OGRSpatialReference* own = layer.GetSpatialRef();
  if (crs_wkt.empty() || own == nullptr || own->IsEmpty() || own->IsLocal() != 0) return nullptr;
  OGRSpatialReference from(*own);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return transformation(from, spatial_reference(crs_wkt), file.string());
}

}  // namespace

struct VectorLayer::Opened {
  WhileReading while_reading;
  QuietErrors errors{};
  Dataset dataset{};
  OGRLayer* layer = nullptr;
  Transformation transformation{};  ///< none: shapes stay where they are

  explicit Opened(const fs::path& file) : while_reading(file, "Copy or download it again") {}
};

VectorLayer::VectorLayer(const fs::path& text, const std::string& crs_wkt, const std::string& usual)
    : source_(vector_source(text)), opened_(std::make_unique<Opened>(file())) {
  opened_->dataset = open_vector(file());
  opened_->layer = layer_of(*opened_->dataset, source_, usual);
  if (!where().empty() &&
      (layer().SetAttributeFilter(as_in(layer(), where()).c_str()) != OGRERR_NONE || opened_->errors.failed()))
    throw DataError({fmt::format("{}: the condition {} cannot be understood", file().string(), where()),
                     opened_->errors.text(),
                     "Write it with the names of attributes: id = 12, or state = 'active'; ogrinfo -so lists them"});
  opened_->transformation = transformation_to(layer(), crs_wkt, file());
}

VectorLayer::~VectorLayer() = default;

OGRLayer& VectorLayer::layer() const { return *opened_->layer; }

std::unique_ptr<OGRGeometry> VectorLayer::shape_of(const OGRFeature& feature) const {
  if (feature.GetGeometryRef() == nullptr) return nullptr;
  std::unique_ptr<OGRGeometry> shape(feature.GetGeometryRef()->getLinearGeometry());  // arcs become short chords
  OGRCoordinateTransformation* way = opened_->transformation.get();
  if (way == nullptr || shape->transform(way) == OGRERR_NONE) return shape;
  const char* what = wkbFlatten(shape->getGeometryType()) == wkbPolygon ? "a polygon" : "a shape";
  throw DataError({fmt::format("{}: {} cannot be brought to the working CRS", file().string(), what),
                   opened_->errors.text(),
                   "Its coordinates do not fit its CRS. Name the true one: ogr2ogr -a_srs EPSG:<code> out.gpkg " +
                       file().string()});
}

std::string VectorLayer::name() const { return text(layer().GetName()); }

std::string VectorLayer::text(const char* bytes) const {
  if (!is_utf8(bytes)) {
    const std::string name = file().string();
    const bool shapefile = file().extension() == ".shp" || file().extension() == ".dbf";
    warn("text-encoding",
         fmt::format(
             "{}: its text is not UTF-8 and is taken as CP1252 (Western European). Where letters come out wrong, "
             "{}",
             name,
             shapefile ? "name its encoding: echo CP1250 > " + fs::path(file()).replace_extension(".cpg").string()
                       : "save the file again with the encoding UTF-8"));
  }
  return as_utf8(bytes);
}

void VectorLayer::require_whole() const {
  if (opened_->errors.failed())
    throw DataError({file().string() + ": cannot be read to its end", opened_->errors.text(),
                     "Look at it: ogrinfo -al " + file().string()});
}

Fault VectorLayer::none_found(const std::string& what, const std::string& other, const std::string& mend) const {
  const auto features = layer().GetFeatureCount();
  const std::string nothing = !where().empty() ? "none meets it"
                              : features <= 0
                                  ? "the layer is empty"
                                  : fmt::format(
                                        "it has {} rows without a shape; of a CSV file a column \"WKT\" holds "
                                        "shapes",
                                        features);
  return {fmt::format("{}: no {} in layer \"{}\"{}", file().string(), what, name(),
                      where().empty() ? "" : " whose attributes meet " + where()),
          other.empty() ? nothing : "it holds " + other, mend + " (FILE|layername=LAYER|subset=CONDITION)"};
}

void for_each_part(const OGRGeometry& shape, const std::function<void(const OGRGeometry&)>& take) {
  if (OGR_GT_IsSubClassOf(shape.getGeometryType(), wkbGeometryCollection) == 0) return take(shape);
  for (const OGRGeometry* part : *shape.toGeometryCollection()) for_each_part(*part, take);
}

OGRPolygon ogr_polygon(const MapPolygon& polygon) {
  OGRPolygon shape;
  for (const auto& ring : polygon.rings) {
    OGRLinearRing line;
    for (const auto& [x, y] : ring) line.addPoint(x, y);
    line.closeRings();
    shape.addRing(&line);
  }
  return shape;
}

bool is_numeric(const OGRFeature& feature, int field) {
  const OGRFieldType type = feature.GetFieldDefnRef(field)->GetType();
  return type == OFTInteger || type == OFTInteger64 || type == OFTReal ||
         (type == OFTString && CPLGetValueType(feature.GetFieldAsString(field)) != CPL_VALUE_STRING);
}

std::vector<FeatureValue> values_of(const VectorLayer& from, const OGRFeature& feature) {
  std::vector<FeatureValue> values;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    FeatureValue value{.name = from.text(feature.GetFieldDefnRef(i)->GetNameRef()), .number = {}, .text = {}};
    value.is_null = !feature.IsFieldSetAndNotNull(i);
    if (!value.is_null) value.text = from.text(feature.GetFieldAsString(i));
    if (!value.is_null && is_numeric(feature, i)) value.number = feature.GetFieldAsDouble(i);
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace talus::gdal

namespace talus {
namespace fs = std::filesystem;
namespace {

gdal::Dataset open(const fs::path& file, unsigned kind) {
  gdal::require_local(file);
  return gdal::Dataset(GDALDataset::Open(file.c_str(), kind | GDAL_OF_READONLY));
}

/// An ASCII grid is opened as one, so that its cells are not looked at.
gdal::Dataset open_raster(const fs::path& file) {
  if (!gdal::begins_as_ascii_grid(file)) return open(file, GDAL_OF_RASTER);
  gdal::require_local(file);
  return gdal::open_ascii_grid(file.string(), GDAL_OF_RASTER | GDAL_OF_READONLY);
}

bool is_point(const OGRGeometry* geometry) {
  return geometry != nullptr && wkbFlatten(geometry->getGeometryType()) == wkbPoint;
}

std::string name_of(const OGRFeatureDefn& fields, int field) {
  return as_utf8(const_cast<OGRFeatureDefn&>(fields).GetFieldDefn(field)->GetNameRef());
}

int field_of(const OGRFeatureDefn& fields, const std::function<bool(std::string_view)>& is_wanted) {
  int found = -1;
  for (int i = 0; i < fields.GetFieldCount(); ++i)
    if (is_wanted(name_of(fields, i))) found = i;
  return found;
}

}  // namespace

std::optional<RasterGlance> glance_at_raster(const fs::path& file) {
  const gdal::QuietErrors errors;
  const gdal::Dataset raster = open_raster(file);
  if (!raster && gdal::begins_as_ascii_grid(file)) return RasterGlance{"AAIGrid", 0};
  if (!raster) return std::nullopt;
  return RasterGlance{
      raster->GetDriver() == nullptr ? "" : raster->GetDriver()->GetDescription(),
      static_cast<std::size_t>(raster->GetRasterXSize()) * static_cast<std::size_t>(raster->GetRasterYSize())};
}

bool holds_points(const fs::path& file) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file, GDAL_OF_VECTOR);
  if (!dataset || dataset->GetLayerCount() == 0) return false;
  OGRLayer& layer = *dataset->GetLayer(0);
  const auto kind = wkbFlatten(layer.GetGeomType());
  if (kind != wkbUnknown) return kind == wkbPoint;
  layer.ResetReading();
  const OGRFeatureUniquePtr feature(layer.GetNextFeature());
  return feature && is_point(feature->GetGeometryRef());
}

PointLayer read_point_layer(const fs::path& file, const ZAttributes& attributes) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file, GDAL_OF_VECTOR);
  if (!dataset || dataset->GetLayerCount() == 0)
    throw DataError(gdal::no_dataset(file, "points", errors.text(), "ogrinfo"));
  OGRLayer& layer = *dataset->GetLayer(0);
  PointLayer points;
  points.crs_wkt = gdal::horizontal_wkt(layer.GetSpatialRef());
  points.heights = gdal::declared_heights(layer.GetSpatialRef(), file);
  const OGRFeatureDefn& fields = *layer.GetLayerDefn();
  const int first = field_of(fields, attributes.first), known = field_of(fields, attributes.known);
  for (const auto& feature : layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (!is_point(geometry)) continue;
    const OGRPoint& point = *geometry->toPoint();
    const bool in_geometry = first < 0 && point.Is3D();
    const int field = first >= 0 ? first : known;
    if (!in_geometry && (field < 0 || !feature->IsFieldSetAndNotNull(field)))
      throw DataError({fmt::format("{}: point {} has no elevation", file.string(), feature->GetFID()),
                       first < 0 ? "neither its geometry nor an attribute z, elevation or height holds one"
                                 : "its attribute " + name_of(fields, first) + " is empty",
                       "Rename the attribute: ogr2ogr -sql \"SELECT *, <column> AS z FROM <layer>\" out.gpkg in.gpkg"});
    if (!in_geometry && !gdal::is_numeric(*feature, field))
      throw DataError({fmt::format("{}: point {}: {} = \"{}\"", file.string(), feature->GetFID(),
                                   name_of(fields, field), as_utf8(feature->GetFieldAsString(field))),
                       "an elevation is a number", "Write it with a point for its decimals"});
    points.x.push_back(point.getX());
    points.y.push_back(point.getY());
    points.z.push_back(in_geometry ? point.getZ() : feature->GetFieldAsDouble(field));
    if (!in_geometry) points.z_name = name_of(fields, field);
  }
  if (errors.failed())
    throw DataError(
        {file.string() + ": cannot be read to its end", errors.text(), "Look at it: ogrinfo -al " + file.string()});
  return points;
}

}  // namespace talus
