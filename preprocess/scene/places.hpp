// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From vector files of lines and points to places of the domain.
#pragma once

#include <vector>

#include "common/domain/domain_place.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/places.hpp"

namespace talus::preprocess {

/// The lines and points that the recipe names, on a map of the ground's CRS, each under its name. Throws DataError,
/// which names every feature at fault: what read_place_layer() refuses, a feature without a name or with that of
/// another one of its place, one that lies outside the ground.
std::vector<DomainPlace> read_places(const std::vector<PlaceOptions>& options, const Raster& ground);

}  // namespace talus::preprocess
