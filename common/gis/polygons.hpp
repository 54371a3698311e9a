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

namespace talus {

/// Which features of a vector file are read.
struct LayerChoice {
  std::string layer = {};  ///< of the file; empty, or where there is none of that name: the first
  std::string where = {};  ///< condition on its attributes, as OGR takes it (`"fid" = 12`); empty: all
};

/// All polygons of a layer (multipolygons split), transformed to `crs_wkt` when both have a CRS. Throws DataError: no
/// such file, not a vector file, no polygon in it, a condition that cannot be understood.
std::vector<MapPolygon> read_polygons(const std::filesystem::path& file, const std::string& crs_wkt,
                                      const LayerChoice& choice = {});

/// An attribute of a feature.
struct FeatureValue {
  std::string name;
  bool is_null = false;
  std::optional<double> number;  ///< none: it is text
  std::string text;              ///< in either case
};

/// A feature of polygons with all its attributes.
struct PolygonFeature {
  std::string where;  ///< the condition that chooses it alone
  std::string place;  ///< "areas.gpkg, feature 12", for messages
  std::int64_t number = 0;
  std::vector<MapPolygon> polygons;
  std::vector<FeatureValue> values;
};

/// The features of a layer, read in one pass, transformed as read_polygons() does. Throws DataError likewise; a layer
/// that is named must be there.
std::vector<PolygonFeature> read_polygon_features(const std::filesystem::path& file, const std::string& crs_wkt,
                                                  const LayerChoice& choice = {});

/// All lines of a vector file's first layer (multilines split), transformed to `crs_wkt` when both have a CRS. Throws
/// DataError: no such file, not a vector file, no line in it.
std::vector<MapLine> read_lines(const std::filesystem::path& file, const std::string& crs_wkt);

}  // namespace talus
