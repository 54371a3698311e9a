// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Single lines and points out of vector files, each with its attributes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/gis/polygons.hpp"

namespace talus {

/// A feature that is one line or one point.
struct PlaceFeature {
  std::string place;  ///< "lines.gpkg, feature 12", for messages
  std::int64_t number = 0;
  MapLine points;  ///< map coordinates [m]; one: a point
  std::vector<FeatureValue> values;
};

/// What of a layer was chosen.
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
