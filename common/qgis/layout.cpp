// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/project.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace talus {
namespace {

/// A rectangle on the page [mm].
struct Place {
  double x, y, width, height;
};

constexpr Place page{0, 0, 297, 210};
constexpr Place title_place{10, 7, 277, 9}, subtitle_place{10, 16, 277, 6}, map_place{10, 24, 205, 166};
constexpr Place legend_place{219, 24, 68, 140}, bar_place{219, 172, 68, 14}, north_place{196, 27, 15, 17};
constexpr Place sources_place{10, 192, 277, 13};

constexpr std::size_t legend_letters = 36;  // that stand beside one another in the legend

/// The ids of the items; the same in every run, so that a project compares equal to one made before.
constexpr const char* map_id = "{74616c75-7300-4000-8000-6d6170000001}";
std::string item_id(int number) { return fmt::format("{{74616c75-7300-4000-8000-6974656d{:04}}}", number); }

/// The numbers by which QGIS knows its kinds of items.
enum Kind { page_item = 65638, map_item = 65639, picture = 65640, label = 65641, legend_item = 65642, bar = 65646 };

void add_colour(XmlElement item, const char* name, int level, int alpha) {
  const std::string value = fmt::format("{}", level);
  item.add(name, {{"red", value}, {"green", value}, {"blue", value}, {"alpha", fmt::format("{}", alpha)}});
}

/// An item with what all of them have. Those of higher `rank` lie above the others.
XmlElement add_item(XmlElement layout, Kind kind, const std::string& name, int rank, const Place& place) {
  const std::string at = fmt::format("{},{},mm", place.x, place.y), id = kind == map_item ? map_id : item_id(rank);
  XmlElement item = layout.add("LayoutItem", {{"type", fmt::format("{}", static_cast<int>(kind))},
                                              {"id", name},
                                              {"uuid", id},
                                              {"templateUuid", id},
                                              {"size", fmt::format("{},{},mm", place.width, place.height)},
                                              {"position", at},
                                              {"positionOnPage", at},
                                              {"referencePoint", "0"},
                                              {"zValue", fmt::format("{}", rank)},
                                              {"visibility", "1"},
                                              {"opacity", "1"},
                                              {"frame", kind == map_item ? "true" : "false"},
                                              {"outlineWidthM", "0.3,mm"},
                                              {"frameJoinStyle", "miter"},
                                              {"background", kind == map_item || kind == page_item ? "true" : "false"},
                                              {"positionLock", "false"},
                                              {"blendMode", "0"},
                                              {"excludeFromExports", "0"},
                                              {"itemRotation", "0"},
                                              {"groupUuid", ""}});
  add_colour(item, "FrameColor", 0, 255);
  add_colour(item, "BackgroundColor", 255, 255);
  return item;
}

/// White paper without an outline.
void add_page(XmlElement layout) {
  XmlElement collection = layout.add("PageCollection");
  const auto add_paper = [](XmlElement parent) {
    XmlElement fill = parent.add("symbol", {{"type", "fill"}, {"name", ""}, {"alpha", "1"}, {"clip_to_extent", "1"}})
                          .add("layer", {{"class", "SimpleFill"}, {"enabled", "1"}, {"locked", "0"}, {"pass", "0"}});
    for (const auto& [key, value] :
         {std::pair{"color", "255,255,255,255"}, {"style", "solid"}, {"outline_style", "no"}})
      fill.add("prop", {{"k", key}, {"v", value}});
  };
  add_paper(collection);
  add_paper(add_item(collection, page_item, "", 0, page));
  collection.add("GuideCollection", {{"visible", "1"}});
}

void add_map(XmlElement layout, const ProjectView& view) {
  XmlElement item = add_item(layout, map_item, "Map", 1, map_place);
  item.set("keepLayerSet", "false");
  item.set("followPreset", "false");
  item.set("mapRotation", "0");
  item.set("drawCanvasItems", "true");
  item.set("isTemporal", "0");
  const ProjectView seen = of_aspect(view, map_place.width / map_place.height);
  item.add("Extent", {{"xmin", fmt::format("{}", seen.west)},
                      {"ymin", fmt::format("{}", seen.south)},
                      {"xmax", fmt::format("{}", seen.east)},
                      {"ymax", fmt::format("{}", seen.north)}});
  item.add("LayerSet");
}

/// QGIS computes what stands between "[%" and "%]" in a text; names of scenes are no formulas.
std::string as_text(std::string words) {
  for (std::size_t at = words.find("[%"); at != std::string::npos; at = words.find("[%")) words.insert(at + 1, " ");
  return words;
}

struct Letters {
  double points;
  bool bold;
};

std::string font(const Letters& letters) {
  return fmt::format("Sans Serif,{},-1,5,{},0,0,0,0,0", letters.points, letters.bold ? 75 : 50);
}

void add_label(XmlElement layout, const std::string& name, int rank, const Place& place, const std::string& text,
               const Letters& letters) {
  XmlElement item = add_item(layout, label, name, rank, place);
  item.set("labelText", as_text(text));
  item.set("htmlState", "0");
  item.set("halign", "1");
  item.set("valign", "32");
  item.set("marginX", "0");
  item.set("marginY", "0");
  item.add("LabelFont", {{"description", font(letters)}, {"style", ""}});
  add_colour(item, "FontColor", 30, 255);
}

/// Of a raster QGIS lists its band first, which says no more than the name above it: the classes alone are asked for.
void add_entry(XmlElement tree, const LegendEntry& entry) {
  XmlElement layer =
      tree.add("layer-tree-layer",
               {{"id", entry.id}, {"name", as_text(entry.name)}, {"checked", "Qt::Checked"}, {"expanded", "1"}});
  XmlElement properties = layer.add("customproperties").add("Option", {{"type", "Map"}});
  const auto add = [&](const char* name, const std::string& value) {
    properties.add("Option", {{"type", "QString"}, {"name", name}, {"value", value}});
  };
  add("legend/title-label", as_text(in_lines(entry.name, legend_letters)));
  std::string order;
  for (std::size_t i = 1; i <= entry.classes; ++i) order += (i > 1 ? "," : "") + fmt::format("{}", i);
  if (!order.empty()) add("legend/node-order", order);
}

void add_legend(XmlElement layout, const std::vector<LegendEntry>& entries) {
  XmlElement item = add_item(layout, legend_item, "Legend", 5, legend_place);
  item.set("map_uuid", map_id);
  for (const auto& [key, value] : {std::pair{"title", ""},
                                   {"symbolWidth", "6"},
                                   {"symbolHeight", "3.5"},
                                   {"boxSpace", "0"},
                                   {"columnCount", "1"},
                                   {"columnSpace", "2"},
                                   {"lineSpacing", "1"},
                                   {"resizeToContents", "1"},
                                   {"wrapChar", line_break},
                                   {"fontColor", "#1e1e1e"},
                                   {"rasterBorder", "0"}})
    item.set(key, value);
  XmlElement styles = item.add("styles");
  for (const auto& [name, points, above] :
       {std::tuple{"title", 10, "0"}, {"group", 9, "3"}, {"subgroup", 9, "3"}, {"symbol", 8, "0.8"}})
    styles.add("style", {{"name", name}, {"alignment", "1"}, {"indent", "0"}, {"marginTop", above}})
        .add("styleFont", {{"description", font({static_cast<double>(points), points > 8})}, {"style", ""}});
  styles
      .add("style",
           {{"name", "symbolLabel"}, {"alignment", "1"}, {"indent", "0"}, {"marginTop", "0.8"}, {"marginLeft", "2"}})
      .add("styleFont", {{"description", font({8, false})}, {"style", ""}});
  XmlElement tree = item.add("layer-tree-group");
  for (const LegendEntry& entry : entries) add_entry(tree, entry);
}

void add_scale_bar(XmlElement layout, double width) {
  const double segment = scale_bar_segment(width);
  const bool kilometres = segment >= 1000;
  const double unit = kilometres ? 1000 : 1;
  XmlElement item = add_item(layout, bar, "Scale bar", 6, bar_place);
  item.set("mapUuid", map_id);
  item.set("style", "Single Box");
  item.set("unitType", kilometres ? "km" : "meters");
  item.set("unitLabel", kilometres ? "km" : "m");
  item.set("numMapUnitsPerScaleBarUnit", "1");
  item.set("numUnitsPerSegment", fmt::format("{}", segment / unit));
  item.set("numSegments", "2");
  item.set("numSegmentsLeft", "0");
  item.set("segmentSizeMode", "0");
  item.set("height", "2");
  item.set("labelBarSpace", "1.5");
  item.set("boxContentSpace", "1");
  item.set("alignment", "0");
  item.add("text-style", {{"fontSize", "8"},
                          {"fontSizeUnit", "Point"},
                          {"fontWeight", "50"},
                          {"fontFamily", "Sans Serif"},
                          {"textColor", "30,30,30,255"},
                          {"textOpacity", "1"}});
}

void add_north_arrow(XmlElement layout) {
  XmlElement item = add_item(layout, picture, "North arrow", 7, north_place);
  item.set("file", "arrows/NorthArrow_02.svg");  // of those that come with QGIS
  item.set("mode", "2");                         // an SVG
  item.set("resizeMode", "0");
  item.set("anchorPoint", "4");
  item.set("northMode", "0");
  item.set("northOffset", "0");
  item.set("mapUuid", map_id);
  item.set("pictureRotation", "0");
  item.set("svgFillColor", "30,30,30,255");
  item.set("svgBorderColor", "30,30,30,255");
  item.set("svgBorderWidth", "0.2");
}

}  // namespace

ProjectView of_aspect(const ProjectView& view, double aspect) {
  const double width = view.east - view.west, height = view.north - view.south;
  const double x = 0.5 * (view.west + view.east), y = 0.5 * (view.south + view.north);
  const double half_width = 0.5 * std::max(width, aspect * height), half_height = half_width / aspect;
  return {x - half_width, y - half_height, x + half_width, y + half_height};
}

std::string in_lines(const std::string& name, std::size_t most) {
  std::string text;
  std::size_t line = 0;
  const auto put = [&](const std::string& piece) {
    const bool fits = line + 1 + piece.size() <= most;
    if (!text.empty()) text += fits ? " " : line_break;
    text += piece;
    line = !fits || line == 0 ? piece.size() : line + 1 + piece.size();
  };
  std::istringstream words(name);
  for (std::string word; words >> word;) {
    while (word.size() > most) {
      std::size_t end = most;
      while (end < word.size() && (static_cast<unsigned char>(word[end]) & 0xC0U) == 0x80U) ++end;  // whole letters
      put(word.substr(0, end));
      line = most;
      word.erase(0, end);
    }
    if (!word.empty()) put(word);
  }
  return text;
}

double scale_bar_segment(double width) {
  const double most = width / 8, power = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * power <= most) return step * power;
  return power;
}

void add_print_layout(XmlElement layouts, const PrintLayout& layout, const ProjectView& view,
                      const std::vector<LegendEntry>& legend) {
  XmlElement element =
      layouts.add("Layout", {{"name", layout.name}, {"units", "mm"}, {"printResolution", "300"}, {"worldFileMap", ""}});
  add_page(element);
  add_map(element, view);
  add_label(element, "Title", 2, title_place, layout.title, {16, true});
  add_label(element, "Subtitle", 3, subtitle_place, layout.subtitle, {9, false});
  add_label(element, "Sources", 4, sources_place, layout.sources, {7, false});
  add_legend(element, legend);
  const ProjectView seen = of_aspect(view, map_place.width / map_place.height);
  add_scale_bar(element, seen.east - seen.west);
  add_north_arrow(element);
}

}  // namespace talus
