// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons and lines out of vector files, through OGR.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/recipe/vector_source.hpp"

namespace talus {

/// All polygons of a vector source (multipolygons split), transformed to `crs_wkt` when both have a CRS. Where the
/// source names no layer, that called `usual` is read if there is one, else the first. Throws DataError: no such file,
/// not a vector file, no layer of the name, no polygon in it, a condition that cannot be understood.
std::vector<MapPolygon> read_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                      const std::string& usual = {});

/// An attribute of a feature.
struct FeatureValue {
  std::string name;
  bool is_null = false;
  std::optional<double> number;  ///< none: it is text
  std::string text;              ///< in either case
};

/// A feature of polygons with all its attributes.
struct PolygonFeature {
  std::filesystem::path source;  ///< the text that chooses it alone
  std::string place;             ///< "areas.gpkg, feature 12", for messages
  std::int64_t number = 0;
  std::vector<MapPolygon> polygons;
  std::vector<FeatureValue> values;
};

/// The features of a layer, read in one pass, transformed as read_polygons() does. Throws DataError likewise, unless
/// there is none.
std::vector<PolygonFeature> read_polygon_features(const std::filesystem::path& source, const std::string& crs_wkt);

/// All lines of a vector source (multilines split), transformed to `crs_wkt` when both have a CRS. Throws DataError
/// likewise.
std::vector<MapLine> read_lines(const std::filesystem::path& source, const std::string& crs_wkt);

}  // namespace talus
