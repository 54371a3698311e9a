// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the readers of vector files share: a layer opened, its features chosen and carried to another CRS. Nobody else
// includes it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/gis/polygons.hpp"

class GDALDataset;
class OGRCoordinateTransformation;
class OGRFeature;
class OGRGeometry;
class OGRLayer;

namespace talus::gdal {

class QuietErrors;  // of gdal_support.hpp, which sources include
struct CloseDataset;
struct DestroyTransformation;
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;
using Transformation = std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>;

/// A vector file with a layer at least. Throws DataError.
Dataset open_vector(const std::filesystem::path& file);

/// The layer of a name, the first where that is empty. Throws DataError where there is none of that name.
OGRLayer& layer_named(GDALDataset& dataset, const std::filesystem::path& file, const std::string& name);

/// Only those features whose attributes meet a condition are read from now on. Throws DataError where it cannot be
/// understood.
void choose_features(OGRLayer& layer, const std::filesystem::path& file, const std::string& where,
                     const QuietErrors& errors);

/// "layer whose attributes meet CONDITION", for messages; empty where there is no condition.
std::string condition_words(const LayerChoice& choice);

/// The way from a layer's CRS to another; none where one of them is not named.
Transformation transformation_to(OGRLayer& layer, const std::string& crs_wkt);

/// Carries a shape along; none: it stays. Throws DataError.
void carry(const std::filesystem::path& file, OGRCoordinateTransformation* transform, OGRGeometry& shape,
           const QuietErrors& errors);

/// Throws DataError where a call has failed on the way.
void require_whole(const std::filesystem::path& file, const QuietErrors& errors);

/// Text that is a number as a whole counts as one.
bool is_numeric(const OGRFeature& feature, int field);

/// The attributes of a feature.
std::vector<FeatureValue> values_of(const OGRFeature& feature);

}  // namespace talus::gdal
