// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges and obstacles on a map.
#pragma once

#include <vector>

#include "common/map/places.hpp"
#include "postprocess/picture/view.hpp"

namespace talus::postprocess {

/// Draws gauges as dots and obstacles by their outlines, each with its name where they are no more than twelve; what
/// lies outside the view is left out.
void draw_places(Canvas& canvas, const View& view, const std::vector<MapPlace>& places);

/// The name of a place without its kind: "bridge" of "gauge bridge".
std::string name_of(const MapPlace& place);

}  // namespace talus::postprocess
