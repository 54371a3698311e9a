// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What styles and projects of QGIS say of how a layer is drawn.
#pragma once

#include "common/qgis/style.hpp"
#include "common/qgis/xml_tree.hpp"

namespace talus {

/// Into the element of a layer or a style: everything on how the raster's band is drawn.
void add_class_renderer(XmlElement layer, const RasterStyle& style);
/// Adds a grey hillshade lit from four sides to the element of a layer or a style.
void add_hillshade_renderer(XmlElement layer);

/// Adds to the element of a layer of polygons how its outlines are drawn; areas stay empty.
void add_outline_renderer(XmlElement layer, const OutlineStyle& style);

}  // namespace talus
