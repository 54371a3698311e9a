#include "preprocess/terrain/geo_input.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "common/error.hpp"
#include "preprocess/terrain/point_table.hpp"

namespace talus::preprocess {

namespace {

/// GDAL prints to stderr on its own; our messages say the same better.
struct Quiet {
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
};

OGRSpatialReference spatial_reference(const std::string& text) {
  OGRSpatialReference crs;
  Quiet quiet;
  if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) crs.Clear();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::string wkt_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2018", nullptr};
  crs.exportToWkt(&text, options);
  std::string wkt = text ? text : "";
  CPLFree(text);
  return wkt;
}

struct TransformDeleter {
  void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using Transform = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

Transform transform_between(const std::string& from_wkt, const std::string& to_wkt) {
  const OGRSpatialReference from = spatial_reference(from_wkt), to = spatial_reference(to_wkt);
  Transform transform(OGRCreateCoordinateTransformation(&from, &to));
  if (!transform) {
    throw DataError(Fault{"no transformation between two CRS", CPLGetLastErrorMsg(),
                          "Reproject the file first: gdalwarp -t_srs <crs of the first DEM> in.tif out.tif"});
  }
  return transform;
}

using Dataset = std::unique_ptr<GDALDataset>;

Dataset open(const std::filesystem::path& file, unsigned kind) {
  GDALAllRegister();
  Quiet quiet;
  return Dataset(GDALDataset::Open(file.c_str(), kind | GDAL_OF_READONLY));
}

/// Points of a vector layer; z from the geometry, else from an attribute.
ScatteredPoints read_layer(const std::filesystem::path& file, OGRLayer& layer) {
  ScatteredPoints points;
  if (const auto* crs = layer.GetSpatialRef()) points.crs_wkt = wkt_of(*crs);
  int z_field = -1;
  for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
    if (is_z_name(layer.GetLayerDefn()->GetFieldDefn(i)->GetNameRef())) z_field = i;
  }
  layer.ResetReading();
  for (OGRFeatureUniquePtr feature(layer.GetNextFeature()); feature; feature.reset(layer.GetNextFeature())) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (!geometry || wkbFlatten(geometry->getGeometryType()) != wkbPoint) continue;
    const OGRPoint* point = geometry->toPoint();
    if (!point->Is3D() && z_field < 0) {
      throw DataError(
          Fault{fmt::format("{}: point {} has no elevation", file.string(), feature->GetFID()),
                "neither its geometry nor an attribute z, elevation or height holds one",
                "Rename the attribute: ogr2ogr -sql \"SELECT *, <column> AS z FROM <layer>\" out.gpkg in.gpkg"});
    }
    points.x.push_back(point->getX());
    points.y.push_back(point->getY());
    points.z.push_back(point->Is3D() ? point->getZ() : feature->GetFieldAsDouble(z_field));
  }
  return points;
}

bool is_text(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".csv" || extension == ".xyz" || extension == ".txt";
}

/// GDAL takes a table of points for a raster when their distances happen to be multiples of one another.
bool is_sparse_table(const std::filesystem::path& file, GDALDataset& raster) {
  if (!EQUAL(raster.GetDriver()->GetDescription(), "XYZ")) return false;
  const std::size_t cells =
      static_cast<std::size_t>(raster.GetRasterXSize()) * static_cast<std::size_t>(raster.GetRasterYSize());
  return read_point_table(file).x.size() < cells;
}

bool is_point_layer(OGRLayer* layer) {
  if (!layer) return false;
  if (wkbFlatten(layer->GetGeomType()) == wkbPoint) return true;
  if (wkbFlatten(layer->GetGeomType()) != wkbUnknown) return false;
  layer->ResetReading();
  OGRFeatureUniquePtr feature(layer->GetNextFeature());
  return feature && feature->GetGeometryRef() && wkbFlatten(feature->GetGeometryRef()->getGeometryType()) == wkbPoint;
}

}  // namespace

Extent ScatteredPoints::extent() const {
  if (x.empty()) return {};
  const auto [west, east] = std::minmax_element(x.begin(), x.end());
  const auto [south, north] = std::minmax_element(y.begin(), y.end());
  return {*west, *south, *east, *north};
}

std::string metric_crs(const std::string& name) {
  const OGRSpatialReference crs = spatial_reference(name);
  if (crs.IsEmpty()) {
    throw RecipeError(Fault{"[preprocess]: working_crs = \"" + name + "\"", "no such CRS is known",
                            "Name it by its code, as in \"EPSG:32633\""});
  }
  if (!crs.IsProjected() || crs.GetLinearUnits() != 1.0) {
    throw RecipeError(Fault{"[preprocess]: working_crs = \"" + name + "\"", "its coordinates are not in metres",
                            "Name a projected CRS in metres, such as the UTM zone of the place"});
  }
  return wkt_of(crs);
}

Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt) {
  Extent moved;
  const int edge_points = 21;
  if (!transform_between(from_wkt, to_wkt)
           ->TransformBounds(extent.west, extent.south, extent.east, extent.north, &moved.west, &moved.south,
                             &moved.east, &moved.north, edge_points)) {
    throw DataError(Fault{"an extent cannot be moved between two CRS", CPLGetLastErrorMsg(),
                          "Check the CRS of the files with gdalinfo"});
  }
  return moved;
}

bool is_point_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return false;
  if (const Dataset raster = open(file, GDAL_OF_RASTER)) return is_text(file) && is_sparse_table(file, *raster);
  if (is_text(file)) return true;
  const Dataset dataset = open(file, GDAL_OF_VECTOR);
  return dataset && dataset->GetLayerCount() > 0 && is_point_layer(dataset->GetLayer(0));
}

ScatteredPoints read_points(const std::filesystem::path& file) {
  ScatteredPoints points;
  if (is_text(file)) {
    points = read_point_table(file);
  } else {
    const Dataset dataset = open(file, GDAL_OF_VECTOR);
    if (!dataset || dataset->GetLayerCount() == 0) {
      throw DataError(
          Fault{file.string() + ": cannot be read as points", CPLGetLastErrorMsg(), "Check it with ogrinfo"});
    }
    points = read_layer(file, *dataset->GetLayer(0));
  }
  const OGRSpatialReference crs = spatial_reference(points.crs_wkt);
  if (!points.crs_wkt.empty() && (!crs.IsProjected() || crs.GetLinearUnits() != 1.0)) {
    throw DataError(Fault{fmt::format("{}: CRS is {}", file.string(), crs.GetName() ? crs.GetName() : "unknown"),
                          "this stage needs metres", "Reproject: ogr2ogr -t_srs EPSG:<utm> out.gpkg " + file.string()});
  }
  return points;
}

ScatteredPoints transform_points(ScatteredPoints points, const std::string& to_wkt) {
  const Transform transform = transform_between(points.crs_wkt, to_wkt);
  if (!transform->Transform(static_cast<int>(points.x.size()), points.x.data(), points.y.data())) {
    throw DataError(Fault{"points cannot be moved between two CRS", CPLGetLastErrorMsg(), "Reproject: ogr2ogr -t_srs"});
  }
  points.crs_wkt = to_wkt;
  return points;
}

}  // namespace talus::preprocess
