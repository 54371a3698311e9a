// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A project of QGIS that shows a folder of results at once: layers in groups, drawn in their styles.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/qgis/layout.hpp"
#include "common/qgis/style.hpp"

namespace talus {

/// A terrain drawn as a grey hillshade lit from four sides.
struct HillshadeStyle {};

/// An interval of time, UTC, as "1903-04-29T04:10:00.500Z"; the end is not part of it.
struct ProjectTime {
  std::string begin, end;
};

/// One file, or a layer of it, and how it is drawn.
struct ProjectLayer {
  std::string name;    ///< in the legend
  std::string source;  ///< relative to the project: "a.tif", "a.gpkg|layername=b", "NETCDF:\"a.nc\":b"
  bool shown = true;
  std::variant<RasterStyle, HillshadeStyle, OutlineStyle> style;
  std::optional<ProjectTime> time = {};  ///< while the Temporal Controller shows it; empty: always
};

/// Layers under one heading of the legend.
struct ProjectGroup {
  std::string name;
  std::vector<ProjectLayer> layers;  ///< the topmost first
  bool shown = true;
};

/// All that a project shows.
struct QgisProject {
  std::string title;
  std::string crs_wkt;  ///< of everything; empty = local metric coordinates
  ProjectView view;
  std::vector<ProjectGroup> groups;  ///< the topmost first
  std::optional<PrintLayout> layout = {};
};

/// Write a project for QGIS 3 (.qgs). Paths in it are relative: the folder can be moved. Throws DataError (disk full).
void write_qgis_project(const std::filesystem::path& file, const QgisProject& project);

}  // namespace talus
