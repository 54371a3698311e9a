// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/style.hpp"

#include <cmath>

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <fmt/format.h>

#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// XML has no way to write most control characters; names in files may hold them.
std::string writable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = ' ';
  return text;
}

/// QGIS reads numbers as C does, and knows "inf".
std::string number(double value) { return std::isinf(value) ? (value < 0 ? "-inf" : "inf") : fmt::format("{}", value); }

/// Everything finite stands in the list of hidden values: QGIS does not promise to take a bound without end.
double finite(double value) {
  return std::isinf(value) ? std::copysign(std::numeric_limits<float>::max(), value) : value;
}

/// Classes are drawn cell by cell: what is shown are the values that are there. A hillshade needs the surface between
/// the cells before it is shaded, or every cell becomes a step.
enum class Between { nothing, surface };

XmlElement add_pipe(XmlElement layer, Between cells) {
  XmlElement pipe = layer.add("pipe");
  const bool smooth = cells == Between::surface;
  pipe.add("provider")
      .add("resampling", {{"enabled", smooth ? "true" : "false"},
                          {"zoomedInResamplingMethod", smooth ? "cubic" : "nearestNeighbour"},
                          {"zoomedOutResamplingMethod", smooth ? "bilinear" : "nearestNeighbour"},
                          {"maxOversampling", "2"}});
  return pipe;
}

void add_rest_of_pipe(XmlElement layer, XmlElement pipe, Between cells) {
  pipe.add("brightnesscontrast", {{"brightness", "0"}, {"contrast", "0"}, {"gamma", "1"}});
  pipe.add("huesaturation", {{"saturation", "0"}, {"grayscaleMode", "0"}, {"colorizeOn", "0"}});
  pipe.add("rasterresampler", {{"maxOversampling", "2"}});
  pipe.add_text("resamplingStage", cells == Between::surface ? "provider" : "resamplingFilter");
  layer.add_text("blendMode", "0");
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double see_through = 0.85;  // the hillshade below stays readable

XmlDocument style_document() {
  return {"qgis", {{"version", "3.22.0"}, {"styleCategories", "Symbology"}, {"hasScaleBasedVisibilityFlag", "0"}}};
}

fs::path write_beside(const fs::path& raster_file, const XmlDocument& document) {
  fs::path file = raster_file;
  file.replace_extension(".qml");
  write_text(file, document.text(qgis_doctype));
  return file;
}

}  // namespace

XmlElement XmlElement::add(const char* name, Attributes attributes) {
  XmlElement child(CPLCreateXMLNode(node_, CXT_Element, name));
  for (const auto& [key, value] : attributes) child.set(key, value);
  return child;
}

XmlElement XmlElement::add_text(const char* name, const std::string& text) {
  return XmlElement(CPLCreateXMLElementAndValue(node_, name, writable(text).c_str()));
}

void XmlElement::set(const char* key, const std::string& value) {
  CPLAddXMLAttributeAndValue(node_, key, writable(value).c_str());
}

XmlDocument::XmlDocument(const char* root, XmlElement::Attributes attributes)
    : tree_(CPLCreateXMLNode(nullptr, CXT_Element, root), CPLDestroyXMLNode) {
  for (const auto& [key, value] : attributes) this->root().set(key, value);
}

std::string XmlDocument::text(const std::string& doctype) const {
  const std::unique_ptr<char, void (*)(void*)> text(CPLSerializeXMLTree(tree_.get()), CPLFree);
  return doctype + "\n" + text.get();
}

void add_class_renderer(XmlElement layer, const RasterStyle& style) {
  const auto& classes = style.classes;
  const std::string low = number(style.hidden_to);
  const std::string high = number(classes.size() > 1 ? classes[classes.size() - 2].upper : style.hidden_to);
  XmlElement pipe = add_pipe(layer, Between::nothing);
  XmlElement renderer = pipe.add("rasterrenderer", {{"type", "singlebandpseudocolor"},
                                                    {"band", fmt::format("{}", style.band)},
                                                    {"opacity", number(style.opacity)},
                                                    {"alphaBand", "-1"},
                                                    {"nodataColor", ""},
                                                    {"classificationMin", low},
                                                    {"classificationMax", high}});
  XmlElement hidden = renderer.add("rasterTransparency");
  if (style.hidden_from < style.hidden_to)
    hidden.add("singleValuePixelList")
        .add("pixelListEntry", {{"min", number(finite(style.hidden_from))},
                                {"max", number(finite(style.hidden_to))},
                                {"percentTransparent", "100"}});
  XmlElement origin = renderer.add("minMaxOrigin");
  origin.add_text("limits", "None");
  origin.add_text("extent", "WholeRaster");
  XmlElement shader = renderer.add("rastershader")
                          .add("colorrampshader", {{"colorRampType", "DISCRETE"},
                                                   {"classificationMode", "1"},
                                                   {"clip", "0"},
                                                   {"minimumValue", low},
                                                   {"maximumValue", high}});
  for (const auto& one : classes)
    shader.add("item",
               {{"value", number(one.upper)}, {"color", hex(one.colour)}, {"alpha", "255"}, {"label", one.label}});
  add_rest_of_pipe(layer, pipe, Between::nothing);
}

void add_hillshade_renderer(XmlElement layer) {
  XmlElement pipe = add_pipe(layer, Between::surface);
  pipe.add("rasterrenderer", {{"type", "hillshade"},
                              {"band", "1"},
                              {"azimuth", "315"},
                              {"angle", "45"},
                              {"zfactor", "1"},
                              {"multidirection", "1"},
                              {"opacity", "1"},
                              {"alphaBand", "-1"},
                              {"nodataColor", ""}})
      .add("rasterTransparency");
  add_rest_of_pipe(layer, pipe, Between::surface);
}

void add_outline_renderer(XmlElement layer, const OutlineStyle& style) {
  XmlElement symbol = layer.add("renderer-v2", {{"type", "singleSymbol"}, {"symbollevels", "0"}, {"forceraster", "0"}})
                          .add("symbols")
                          .add("symbol", {{"type", "fill"}, {"name", "0"}, {"alpha", "1"}, {"clip_to_extent", "1"}});
  XmlElement fill = symbol.add("layer", {{"class", "SimpleFill"}, {"enabled", "1"}, {"locked", "0"}, {"pass", "0"}});
  const auto byte = [](double v) { return std::lround(255 * v); };
  const auto& c = style.colour;
  const std::pair<const char*, std::string> properties[] = {
      {"style", "no"},
      {"outline_color", fmt::format("{},{},{},255", byte(c.r), byte(c.g), byte(c.b))},
      {"outline_style", style.dashed ? "dash" : "solid"},
      {"outline_width", number(style.width_mm)},
      {"outline_width_unit", "MM"},
      {"joinstyle", "round"}};
  for (const auto& [key, value] : properties) fill.add("prop", {{"k", key}, {"v", value}});
}

RasterStyle class_style(const std::vector<double>& limits, const std::string& unit, Ramp ramp) {
  RasterStyle style{{}, -infinity, limits.empty() ? infinity : limits.front(), see_through};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double upper = i + 1 < limits.size() ? limits[i + 1] : infinity;
    style.classes.push_back({upper, class_colour(i, limits.size(), ramp), class_label(i, limits) + " " + unit});
  }
  return style;
}

RasterStyle time_style(const std::vector<double>& limits, const std::string& unit) {
  RasterStyle style{{}, 0, 0, see_through};
  const std::size_t count = limits.size() + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Colour colour = class_colour(count - 1 - i, count, Ramp::sea);
    std::string label = i == 0 && !limits.empty() ? fmt::format("< {:g}", limits[0])
                        : limits.empty()          ? "all"
                                                  : class_label(i - 1, limits);
    label += " " + unit;
    style.classes.push_back({i < limits.size() ? limits[i] : infinity, colour, label});
  }
  return style;
}

RasterStyle difference_style(const std::vector<double>& limits, const std::string& unit) {
  const std::size_t count = limits.size();
  RasterStyle style{{}, count == 0 ? -infinity : -limits.front(), count == 0 ? infinity : limits.front(), see_through};
  for (std::size_t i = count; i-- > 0;) {
    const auto label = i + 1 == count ? fmt::format("< \u2212{:g} {}", limits[i], unit)
                                      : fmt::format("\u2212{:g} \u2013 \u2212{:g} {}", limits[i + 1], limits[i], unit);
    style.classes.push_back({-limits[i], difference_colour(false, i, count), label});
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double upper = i + 1 < count ? limits[i + 1] : infinity;
    const auto label = i + 1 == count ? fmt::format("> +{:g} {}", limits[i], unit)
                                      : fmt::format("+{:g} \u2013 +{:g} {}", limits[i], limits[i + 1], unit);
    style.classes.push_back({upper, difference_colour(true, i, count), label});
  }
  return style;
}

fs::path write_qgis_style(const fs::path& raster_file, const RasterStyle& style) {
  const XmlDocument document = style_document();
  add_class_renderer(document.root(), style);
  return write_beside(raster_file, document);
}

fs::path write_qgis_hillshade_style(const fs::path& raster_file) {
  const XmlDocument document = style_document();
  add_hillshade_renderer(document.root());
  return write_beside(raster_file, document);
}

}  // namespace talus
