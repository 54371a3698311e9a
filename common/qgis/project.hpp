// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A project of QGIS that shows a folder of results at once: layers in groups, drawn in their styles.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "common/qgis/style.hpp"

namespace talus {

/// A terrain drawn as a grey hillshade lit from four sides.
struct HillshadeStyle {};

/// One file, or a layer of it, and how it is drawn.
struct ProjectLayer {
  std::string name;    ///< in the legend
  std::string source;  ///< relative to the project: "a.tif", "a.gpkg|layername=b"
  bool shown = true;
  std::variant<RasterStyle, HillshadeStyle, OutlineStyle> style;
};

/// Layers under one heading of the legend.
struct ProjectGroup {
  std::string name;
  std::vector<ProjectLayer> layers;  ///< the topmost first
};

/// What is seen first, in map coordinates [m].
struct ProjectView {
  double west = 0, south = 0, east = 0, north = 0;
};

/// All that a project shows.
struct QgisProject {
  std::string title;
  std::string crs_wkt;  ///< of everything; empty = local metric coordinates
  ProjectView view;
  std::vector<ProjectGroup> groups;  ///< the topmost first
};

/// Write a project for QGIS 3 (.qgs). Paths in it are relative: the folder can be moved. Throws DataError (disk full).
void write_qgis_project(const std::filesystem::path& file, const QgisProject& project);

}  // namespace talus
