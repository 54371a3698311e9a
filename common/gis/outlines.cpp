// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines as a GeoPackage, through OGR. Made in memory and written as bytes: SQLite on a full disk would leave its
// journal beside a broken file.
#include "common/gis/outlines.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include "common/error.hpp"
#include "common/gis/features.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"

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
  for (const auto& feature : layer.features)
    for (const auto& [name, unused] : feature.numbers)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
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

/// Twice the area inside a closed line, positive where it runs counter-clockwise [m2].
double twice_area(const Polyline& ring) {
  const auto [x0, y0] = ring.front();  // map coordinates are large: areas lose fewer digits near the ring
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    sum += (ring[i][0] - x0) * (ring[i + 1][1] - y0) - (ring[i + 1][0] - x0) * (ring[i][1] - y0);
  return sum;
}

/// Sets of rings that bound the same area.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t ring) {
    while (parent_[ring] != ring) ring = parent_[ring] = parent_[parent_[ring]];
    return ring;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct Crossing {
  double x;  // [m]
  std::size_t ring;
};

/// Where rings cross the lines through the cell centres of each row, from west to east.
std::vector<std::vector<Crossing>> crossings(const MapGrid& grid, const std::vector<Polyline>& rings) {
  std::vector<std::vector<Crossing>> of_row(static_cast<std::size_t>(grid.rows));
  for (std::size_t ring = 0; ring < rings.size(); ++ring)
    for (std::size_t i = 1; i < rings[ring].size(); ++i) {
      const auto [x, y] = rings[ring][i];
      const long row = std::lround((y - grid.south) / grid.cell - 0.5);
      const bool on_the_row = row >= 0 && row < grid.rows && y == grid.y(static_cast<int>(row));
      if (on_the_row) of_row[static_cast<std::size_t>(row)].push_back({x, ring});
    }
  for (auto& row : of_row) std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return of_row;
}

/// Along a row one crossing leads into the area and the next one out of it again: both belong to the same polygon. A
/// hole is so joined to whatever lies west of it, and that in turn, up to the outer ring.
Groups polygons_of(const MapGrid& grid, const std::vector<Polyline>& rings) {
  Groups groups(rings.size());
  for (const auto& row : crossings(grid, rings))
    for (std::size_t i = 0; i + 1 < row.size(); i += 2) groups.join(row[i].ring, row[i + 1].ring);
  return groups;
}

/// Without the closing point, turned as asked.
Polyline open_ring(Polyline ring, double twice, bool counter_clockwise) {
  ring.pop_back();
  if ((twice > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

constexpr int chords = 36;  // of a quarter of a circle: within 1 - cos(pi / 144), a thousandth of the radius

void add_ring(MapPolygon& polygon, const OGRLinearRing* line) {
  auto& ring = polygon.rings.emplace_back();
  for (int i = 0; line != nullptr && i + 1 < line->getNumPoints(); ++i) ring.push_back({line->getX(i), line->getY(i)});
  if (ring.size() < 3) polygon.rings.pop_back();
}

/// Adds the polygons that a geometry holds, with the attributes of `like`.
void add_shapes(const OGRGeometry& shape, const MapPolygon& like, std::vector<MapPolygon>& polygons) {
  gdal::for_each_part(shape, [&](const OGRGeometry& part) {
    if (wkbFlatten(part.getGeometryType()) != wkbPolygon || part.IsEmpty()) return;
    MapPolygon polygon{{}, like.numbers, like.name};
    const OGRPolygon& rings = *part.toPolygon();
    add_ring(polygon, rings.getExteriorRing());
    if (polygon.rings.empty()) return;
    for (int i = 0; i < rings.getNumInteriorRings(); ++i) add_ring(polygon, rings.getInteriorRing(i));
    polygons.push_back(std::move(polygon));
  });
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

std::vector<MapPolygon> outline_above(const Raster& raster, double threshold) {
  if (!(threshold >= 0))
    throw std::invalid_argument("outline_above: everything outside lies above a negative threshold");
  auto rings = isolines(raster.grid, raster.values, threshold, AtEdge::close);
  auto groups = polygons_of(raster.grid, rings);
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t ring = 0; ring < rings.size(); ++ring) members[groups.of(ring)].push_back(ring);
  std::vector<double> areas;
  areas.reserve(rings.size());
  for (const auto& ring : rings) areas.push_back(twice_area(ring));
  std::vector<MapPolygon> polygons;
  for (auto& [unused, list] : members) {
    const auto larger = [&](std::size_t a, std::size_t b) { return std::abs(areas[a]) > std::abs(areas[b]); };
    std::sort(list.begin(), list.end(), larger);  // the outer ring holds all others
    MapPolygon polygon;
    for (const std::size_t ring : list)
      polygon.rings.push_back(open_ring(std::move(rings[ring]), areas[ring], polygon.rings.empty()));
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

std::string invalidity_of(const MapPolygon& polygon) {
  const OGRPolygon shape = gdal::ogr_polygon(polygon);
  if (shape.IsEmpty()) return "it has no corners";
  std::string why;  // GEOS gives its reason as a warning
  const auto keep = [](CPLErr, CPLErrorNum, const char* message) {
    *static_cast<std::string*>(CPLGetErrorHandlerUserData()) = message;
  };
  CPLPushErrorHandlerEx(keep, &why);
  const bool valid = shape.IsValid() != 0;
  CPLPopErrorHandler();
  return valid ? "" : why.empty() ? "GEOS gives no reason" : why;
}

std::vector<MapPolygon> united(const std::vector<MapPolygon>& polygons, const std::filesystem::path& file) {
  if (polygons.size() < 2) return polygons;
  OGRMultiPolygon all;
  for (const MapPolygon& polygon : polygons) {
    const OGRPolygon shape = gdal::ogr_polygon(polygon);
    all.addGeometry(&shape);
  }
  const gdal::QuietErrors errors;
  const std::unique_ptr<OGRGeometry> shape(all.UnionCascaded());
  if (!shape)
    throw DataError({file.string() + ": its polygons cannot be united", errors.text(),
                     "Unite them in a GIS: ogr2ogr -dialect sqlite -sql \"SELECT ST_Union(geometry) FROM LAYER\""});
  std::vector<MapPolygon> result;
  add_shapes(*shape, polygons.front(), result);
  return result;
}

std::vector<MapPolygon> grown(const std::vector<MapPolygon>& polygons, double distance,
                              const std::filesystem::path& file) {
  if (distance == 0) return polygons;
  if (!OGRGeometryFactory::haveGEOS())
    throw DataError({fmt::format("{}: cannot be grown by {:g} m", file.string(), distance), "this GDAL has no GEOS",
                     "Draw the outline so, and leave grow_m out"});
  std::vector<MapPolygon> result;
  for (const MapPolygon& polygon : polygons) {
    const gdal::QuietErrors errors;
    const std::unique_ptr<OGRGeometry> shape(gdal::ogr_polygon(polygon).Buffer(distance, chords));
    if (!shape)
      throw DataError({fmt::format("{}: cannot be grown by {:g} m", file.string(), distance), errors.text(),
                       "Mend the outline: ogr2ogr -makevalid out.gpkg " + file.string()});
    add_shapes(*shape, polygon, result);
  }
  if (result.empty())
    throw DataError({fmt::format("{}: nothing is left of it with grow_m = {:g}", file.string(), distance),
                     "it is nowhere twice as wide as it was shrunk", "Shrink it less"});
  return result;
}

}  // namespace talus
