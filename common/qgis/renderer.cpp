// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/renderer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace talus {
namespace {

/// QGIS reads numbers as C does, and knows "inf".
std::string number(double value) { return std::isinf(value) ? (value < 0 ? "-inf" : "inf") : fmt::format("{}", value); }

/// Everything finite stands in the list of hidden values: QGIS compares, and a bound without end is not promised to
/// work.
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

}  // namespace

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
  if (style.hidden_from < style.hidden_to) {
    hidden.add("singleValuePixelList")
        .add("pixelListEntry", {{"min", number(finite(style.hidden_from))},
                                {"max", number(finite(style.hidden_to))},
                                {"percentTransparent", "100"}});
  }
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

}  // namespace talus
