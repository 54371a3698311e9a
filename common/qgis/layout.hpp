// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The print layout of a project: a page with the map, its title, legend, scale bar, north arrow and sources.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/qgis/xml_tree.hpp"

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

/// A layer that the legend lists.
struct LegendEntry {
  std::string id, name;
  std::size_t classes = 0;  ///< of a raster, below its name; 0: one symbol, beside it
};

/// What the map of a page shows: `view` and as much around it as makes it as wide over high as `aspect`.
ProjectView of_aspect(const ProjectView& view, double aspect);

/// A name in lines of at most `most` letters, broken at spaces, or inside a word that is longer; `line_break` between
/// them.
std::string in_lines(const std::string& name, std::size_t most);
inline constexpr const char* line_break = "\u2028";

/// A round length of the scale bar's segments, two of which take a quarter of a map `width` wide at most [m].
double scale_bar_segment(double width);

/// Adds the page to the element of a project's layouts.
void add_print_layout(XmlElement layouts, const PrintLayout& layout, const ProjectView& view,
                      const std::vector<LegendEntry>& legend);

}  // namespace talus
