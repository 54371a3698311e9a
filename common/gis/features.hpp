// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons, lines, points and their attributes out of vector files, through OGR; a layer for sources of this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.hpp"
#include "common/gis/declared_heights.hpp"
#include "common/map/polygon.hpp"
#include "common/recipe/paths.hpp"

namespace talus {

/// All polygons of a vector source (multipolygons split), transformed to `crs_wkt` when both have a CRS. Where the
/// source names no layer, that called `usual` is read if there is one, else the first. Throws DataError: no such file,
/// not a vector file, no layer of the name, no polygon in it, a condition that cannot be understood.
std::vector<MapPolygon> read_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                      const std::string& usual = {});

struct FeatureValue {
  std::string name;
  bool is_null = false;
  std::optional<double> number;  ///< none: it is text
  std::string text;              ///< in either case
};

struct PolygonFeature {
  std::filesystem::path source;  ///< the text that chooses it alone
  std::string place;             ///< "areas.gpkg, feature 12", for messages
  std::int64_t number = 0;
  std::vector<MapPolygon> polygons;
  std::vector<FeatureValue> values;
};

/// The features of a layer, read in one pass, transformed and refused as by read_polygons(); there may be none.
std::vector<PolygonFeature> read_polygon_features(const std::filesystem::path& source, const std::string& crs_wkt);

/// All lines of a vector source (multilines split), transformed to `crs_wkt` when both have a CRS. Throws likewise.
std::vector<MapLine> read_lines(const std::filesystem::path& source, const std::string& crs_wkt);

/// An attribute that is set to a text which is no number.
struct TextField {
  long long feature = 0;  ///< its number in the layer, from 1
  std::string field, text;
};

/// The fields of a vector source, in their order. Throws DataError when it cannot be read.
std::vector<std::string> field_names(const std::filesystem::path& source);

/// The attributes whose names `wanted` takes for numbers, and which are set to something else. Throws likewise.
std::vector<TextField> text_fields(const std::filesystem::path& source,
                                   const std::function<bool(std::string_view)>& wanted);

struct PlaceFeature {
  std::string place;  ///< "lines.gpkg, feature 12", for messages
  std::int64_t number = 0;
  MapLine points;  ///< map coordinates [m]; one: a point
  std::vector<FeatureValue> values;
};

struct PlaceLayer {
  std::string name;                 ///< of the layer
  std::string crs_wkt;              ///< that of the file; empty: it names none
  std::vector<std::string> fields;  ///< names of its attributes
  std::vector<PlaceFeature> features;
};

/// The lines and points of a vector source, transformed to `crs_wkt` when both have a CRS. Throws DataError, which
/// names every feature at fault: no such file, not a vector file, no layer of the name, a condition that cannot be
/// understood, no feature, a feature that has no shape, several parts, or another shape than a line or a point.
PlaceLayer read_place_layer(const std::filesystem::path& source, const std::string& crs_wkt);

}  // namespace talus

class OGRFeature;
class OGRGeometry;
class OGRLayer;
class OGRPolygon;

namespace talus::gdal {

/// A layer while it is read: the features of a source, and the way to another CRS.
class VectorLayer {
 public:
  /// Opens a source. Where it names no layer, that called `usual` is taken if there is one, else the first. Throws
  /// DataError: no such file, not a vector file, no layer of the name, a condition that cannot be understood.
  VectorLayer(const std::filesystem::path& text, const std::string& crs_wkt, const std::string& usual = {});
  VectorLayer(const VectorLayer&) = delete;
  VectorLayer& operator=(const VectorLayer&) = delete;
  ~VectorLayer();

  OGRLayer& layer() const;  ///< its features that meet the condition
  const std::filesystem::path& file() const { return source_.file; }
  const std::string& where() const { return source_.where; }
  std::string name() const;  ///< of the layer, UTF-8
  /// Text of the layer as UTF-8. What is none is taken as CP1252, with a warning that names the file.
  std::string text(const char* bytes) const;
  /// A shape as chords, carried to the other CRS; none: the feature has none. Throws DataError.
  std::unique_ptr<OGRGeometry> shape_of(const OGRFeature& feature) const;
  void require_whole() const;  ///< throws DataError where a call has failed on the way
  /// The fault that there is no `what`, but some `other` (empty: nothing).
  Fault none_found(const std::string& what, const std::string& other, const std::string& mend) const;

 private:
  struct Opened;
  VectorSource source_;
  std::unique_ptr<Opened> opened_;
};

/// Calls `take` for a shape and for each part of what is a collection, down to those that are none.
void for_each_part(const OGRGeometry& shape, const std::function<void(const OGRGeometry&)>& take);

/// A polygon as OGR has it, its rings closed.
OGRPolygon ogr_polygon(const MapPolygon& polygon);

/// Text that is a number as a whole counts as one.
bool is_numeric(const OGRFeature& feature, int field);

/// The attributes of a feature, their text as UTF-8.
std::vector<FeatureValue> values_of(const VectorLayer& from, const OGRFeature& feature);

}  // namespace talus::gdal
namespace talus {

/// Points with a height each, as a vector file gives them.
struct PointLayer {
  std::vector<double> x, y, z;   // in the units of their CRS; z as given
  std::string crs_wkt;           // empty = none named
  std::string z_name = {};       // of the attribute that z is; empty = the geometry's
  DeclaredHeights heights = {};  // what the CRS says of them
};

/// What GDAL takes a file for when it is asked for a raster: its driver and count of cells; nullopt when it is none.
struct RasterGlance {
  std::string driver;
  std::size_t cells = 0;
};
/// Opens a file as a raster without reading cells.
std::optional<RasterGlance> glance_at_raster(const std::filesystem::path& file);

/// True when the first layer of a vector file holds points.
bool holds_points(const std::filesystem::path& file);

/// Which attributes hold z, by their names.
struct ZAttributes {
  std::function<bool(std::string_view)> known;                               // where the geometry has none
  std::function<bool(std::string_view)> first = [](auto) { return false; };  // whatever the geometry has
};

/// The points of a vector file's first layer. Throws DataError: not a vector file, a point without elevation.
PointLayer read_point_layer(const std::filesystem::path& file, const ZAttributes& attributes);

}  // namespace talus
