// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How QGIS draws a layer: NAME.qml beside NAME.tif is applied when the raster is opened; the XML that says it, which
// GDAL writes.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/colours.hpp"

struct CPLXMLNode;

namespace talus {

/// One element; the document owns them all.
class XmlElement {
 public:
  using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

  explicit XmlElement(CPLXMLNode* node) : node_(node) {}
  /// A new element inside this one, behind those it has.
  XmlElement add(const char* name, Attributes attributes = {});
  /// Adds an element that holds text, and returns it.
  XmlElement add_text(const char* name, const std::string& text);
  void set(const char* key, const std::string& value);  ///< sets an attribute

 private:
  CPLXMLNode* node_;
};

class XmlDocument {
 public:
  XmlDocument(const char* root, XmlElement::Attributes attributes);
  XmlElement root() const { return XmlElement(tree_.get()); }  ///< the outermost element
  std::string text(const std::string& doctype) const;          ///< the document, with `doctype` above it

 private:
  std::shared_ptr<CPLXMLNode> tree_;
};

inline constexpr const char* qgis_doctype = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>";

}  // namespace talus
namespace talus {

/// Values up to `upper` (and above the class before).
struct StyleClass {
  double upper = std::numeric_limits<double>::infinity();
  Colour colour;
  std::string label;
};

struct RasterStyle {
  std::vector<StyleClass> classes;  ///< rising; the last without end
  double hidden_from = 0;           ///< values from here ...
  double hidden_to = 0;             ///< ... to here are not drawn; nothing is hidden where both are the same
  double opacity = 1;               ///< 0 to 1
  int band = 1;                     ///< of the raster, from 1
};

/// Polygons drawn by their outlines.
struct OutlineStyle {
  Colour colour;
  double width_mm = 0.5;  ///< on paper
  bool dashed = false;
};

/// Classes by their rising lower limits, the last without end; what is below is not drawn. Labels: "5 - 10 m".
RasterStyle class_style(const std::vector<double>& limits, const std::string& unit, Ramp ramp = Ramp::heat);

/// Classes of a quantity whose small values count most (an arrival time), by rising limits: dark first, all drawn.
RasterStyle time_style(const std::vector<double>& limits, const std::string& unit);

/// Classes of a difference, symmetric about zero: losses blue, gains red, by the rising positive `limits`; what is
/// smaller than the first of them is not drawn.
RasterStyle difference_style(const std::vector<double>& limits, const std::string& unit);

/// Write the style of `raster_file` (band 1) beside it, as NAME.qml for QGIS 3; its path. Throws DataError (disk full).
std::filesystem::path write_qgis_style(const std::filesystem::path& raster_file, const RasterStyle& style);

/// Likewise that of a terrain: a grey hillshade lit from four sides.
std::filesystem::path write_qgis_hillshade_style(const std::filesystem::path& raster_file);

/// Into the element of a layer or a style: everything on how the raster's band is drawn.
void add_class_renderer(XmlElement layer, const RasterStyle& style);
/// Adds a grey hillshade lit from four sides to the element of a layer or a style.
void add_hillshade_renderer(XmlElement layer);

/// Adds to the element of a layer of polygons how its outlines are drawn; areas stay empty.
void add_outline_renderer(XmlElement layer, const OutlineStyle& style);

}  // namespace talus
