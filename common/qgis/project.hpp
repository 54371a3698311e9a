// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A project of QGIS that shows a folder of results at once: layers in groups, drawn in their styles.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/qgis/style.hpp"

namespace talus {

/// What is seen, in map coordinates [m].
struct ProjectView {
  double west = 0, south = 0, east = 0, north = 0;
};

/// A page, A4 across.
struct PrintLayout {
  std::string name = "Map, A4";  ///< among the layouts of the project
  std::string title;             ///< above the map
  std::string subtitle;          ///< below the title
  std::string sources;           ///< at the foot of the page: data, version, what a reader has to know
};

struct LegendEntry {
  std::string id, name;
  std::size_t classes = 0;  ///< of a raster, below its name; 0: one symbol, beside it
};

/// What the map of a page shows: `view` and as much around it as makes it as wide over high as `aspect`.
ProjectView of_aspect(const ProjectView& view, double aspect);

/// A name in lines of at most `most` letters, parted by `line_break` at spaces, or inside a word that is longer.
std::string in_lines(const std::string& name, std::size_t most);
inline constexpr const char* line_break = "\u2028";

/// A round length of the scale bar's segments, two of which take a quarter of a map `width` wide at most [m].
double scale_bar_segment(double width);

/// Adds the page to the element of a project's layouts.
void add_print_layout(XmlElement layouts, const PrintLayout& layout, const ProjectView& view,
                      const std::vector<LegendEntry>& legend);

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
