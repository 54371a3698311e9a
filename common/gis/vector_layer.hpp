// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the sources about vector files share: a layer opened, its features chosen and carried to another CRS, polygons
// as OGR has them. Nobody else includes it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/gis/polygons.hpp"

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

  /// Its features that meet the condition.
  OGRLayer& layer() const;
  const std::filesystem::path& file() const { return source_.file; }
  const std::string& where() const { return source_.where; }
  /// A shape as chords, carried to the other CRS; none: the feature has none. Throws DataError.
  std::unique_ptr<OGRGeometry> shape_of(const OGRFeature& feature) const;
  /// Throws DataError where a call has failed on the way.
  void require_whole() const;
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

/// The attributes of a feature.
std::vector<FeatureValue> values_of(const OGRFeature& feature);

}  // namespace talus::gdal
