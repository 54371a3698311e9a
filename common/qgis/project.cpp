// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/project.hpp"

#include <fmt/format.h>

#include "common/gis/gdal_support.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

/// What QGIS knows a CRS by; nothing inside for local coordinates.
void add_crs(XmlElement parent, const std::string& wkt) {
  XmlElement reference = parent.add("spatialrefsys", {{"nativeFormat", "Wkt"}});
  reference.add_text("wkt", wkt);
  if (wkt.empty()) return;
  const OGRSpatialReference srs = gdal::spatial_reference(wkt);
  const std::string name = gdal::short_name(srs);
  const bool has_code = srs.GetAuthorityCode(nullptr) != nullptr;
  reference.add_text("authid", has_code ? name : "");
  reference.add_text("description", srs.GetName() != nullptr ? srs.GetName() : "");
  reference.add_text("geographicflag", "false");
}

void add_extent(XmlElement parent, const ProjectView& view) {
  XmlElement extent = parent.add("extent");
  extent.add_text("xmin", fmt::format("{}", view.west));
  extent.add_text("ymin", fmt::format("{}", view.south));
  extent.add_text("xmax", fmt::format("{}", view.east));
  extent.add_text("ymax", fmt::format("{}", view.north));
}

bool is_raster(const ProjectLayer& layer) { return !std::holds_alternative<OutlineStyle>(layer.style); }
const char* provider(const ProjectLayer& layer) { return is_raster(layer) ? "gdal" : "ogr"; }
const char* checked(bool shown) { return shown ? "Qt::Checked" : "Qt::Unchecked"; }

/// The same in every run, so that projects compare equal. QGIS takes no id of ten letters or fewer.
std::string id_of(std::size_t group, std::size_t layer) { return fmt::format("talus_layer_{:02}_{:02}", group, layer); }

/// As projects hold it: "./a.tif"; of a subdataset the file in it, as QGIS looks for it.
std::string written_source(const std::string& source) {
  const std::string subdataset = "NETCDF:\"";
  return source.starts_with(subdataset) ? subdataset + "./" + source.substr(subdataset.size()) : "./" + source;
}

void add_tree(XmlElement root, const QgisProject& project) {
  XmlElement tree = root.add("layer-tree-group");
  for (std::size_t g = 0; g < project.groups.size(); ++g) {
    const auto& layers = project.groups[g].layers;
    const bool group_shown = project.groups[g].shown;
    XmlElement group = tree.add(
        "layer-tree-group",
        {{"name", project.groups[g].name}, {"checked", checked(group_shown)}, {"expanded", group_shown ? "1" : "0"}});
    for (std::size_t i = 0; i < layers.size(); ++i) {
      group.add("layer-tree-layer", {{"id", id_of(g, i)},
                                     {"name", layers[i].name},
                                     {"source", written_source(layers[i].source)},
                                     {"providerKey", provider(layers[i])},
                                     {"checked", checked(layers[i].shown)},
                                     {"expanded", layers[i].shown && is_raster(layers[i]) ? "1" : "0"}});
    }
  }
}

struct AddRenderer {
  XmlElement layer;
  void operator()(const RasterStyle& style) const { add_class_renderer(layer, style); }
  void operator()(const HillshadeStyle&) const { add_hillshade_renderer(layer); }
  void operator()(const OutlineStyle& style) const { add_outline_renderer(layer, style); }
};

/// When the Temporal Controller shows a raster: mode 0 of QGIS, a fixed range.
void add_time(XmlElement layer, const ProjectTime& time) {
  XmlElement range = layer.add("temporal", {{"enabled", "1"}, {"mode", "0"}, {"fetchMode", "0"}}).add("fixedRange");
  range.add_text("start", time.begin);
  range.add_text("end", time.end);
}

void add_layer(XmlElement layers, const ProjectLayer& layer, const std::string& id, const std::string& crs) {
  XmlElement element = layers.add("maplayer", {{"type", is_raster(layer) ? "raster" : "vector"},
                                               {"hasScaleBasedVisibilityFlag", "0"},
                                               {"styleCategories", "AllStyleCategories"}});
  if (!is_raster(layer)) {
    element.set("geometry", "Polygon");
    element.set("wkbType", "MultiPolygon");
  }
  element.add_text("id", id);
  element.add_text("datasource", written_source(layer.source));
  element.add_text("layername", layer.name);
  add_crs(element.add("srs"), crs);
  element.add_text("provider", provider(layer));
  if (layer.time) add_time(element, *layer.time);
  std::visit(AddRenderer{element}, layer.style);
}

void add_canvas(XmlElement root, const QgisProject& project) {
  XmlElement canvas = root.add("mapcanvas", {{"name", "theMapCanvas"}, {"annotationsVisible", "1"}});
  canvas.add_text("units", "meters");
  add_extent(canvas, project.view);
  canvas.add_text("rotation", "0");
  add_crs(canvas.add("destinationsrs"), project.crs_wkt);
  const ProjectView& view = project.view;
  XmlElement settings = root.add("ProjectViewSettings", {{"UseProjectScales", "0"}, {"rotation", "0"}});
  add_crs(settings.add("DefaultViewExtent", {{"xmin", fmt::format("{}", view.west)},
                                             {"ymin", fmt::format("{}", view.south)},
                                             {"xmax", fmt::format("{}", view.east)},
                                             {"ymax", fmt::format("{}", view.north)}}),
          project.crs_wkt);
}

/// From when to when, and how fast, the Temporal Controller goes through the layers that have a time: one by one.
void add_times(XmlElement root, const QgisProject& project) {
  std::string begin, end;
  for (const ProjectGroup& group : project.groups)
    for (const ProjectLayer& layer : group.layers) {
      if (!layer.time) continue;
      if (begin.empty() || layer.time->begin < begin) begin = layer.time->begin;
      if (layer.time->end > end) end = layer.time->end;
    }
  if (begin.empty()) return;
  XmlElement range =
      root.add("ProjectTimeSettings",
               {{"cumulativeTemporalRange", "0"}, {"frameRate", "4"}, {"timeStep", "1"}, {"timeStepUnit", "s"}})
          .add("TemporalRange");
  range.add_text("start", begin);
  range.add_text("end", end);
}

/// What the print layout lists: the layers that are shown at first, without the ground below them.
std::vector<LegendEntry> shown_layers(const QgisProject& project) {
  std::vector<LegendEntry> entries;
  for (std::size_t g = 0; g < project.groups.size(); ++g) {
    if (!project.groups[g].shown) continue;
    const auto& layers = project.groups[g].layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (!layers[i].shown || std::holds_alternative<HillshadeStyle>(layers[i].style)) continue;
      const auto* raster = std::get_if<RasterStyle>(&layers[i].style);
      entries.push_back({id_of(g, i), layers[i].name, raster == nullptr ? 0 : raster->classes.size()});
    }
  }
  return entries;
}

void add_properties(XmlElement root, bool has_crs) {
  XmlElement properties = root.add("properties");
  XmlElement absolute = properties.add("Paths").add_text("Absolute", "false");
  absolute.set("type", "bool");
  XmlElement projections = properties.add("SpatialRefSys").add_text("ProjectionsEnabled", has_crs ? "1" : "0");
  projections.set("type", "int");
}

}  // namespace

void write_qgis_project(const std::filesystem::path& file, const QgisProject& project) {
  const gdal::QuietErrors errors;
  const std::string& crs = project.crs_wkt;
  const XmlDocument document("qgis", {{"version", "3.22.0"}, {"projectname", project.title}});
  XmlElement root = document.root();
  root.add("homePath", {{"path", ""}});
  root.add_text("title", project.title);
  add_crs(root.add("projectCrs"), crs);
  add_tree(root, project);
  add_canvas(root, project);
  XmlElement layers = root.add("projectlayers");
  for (std::size_t g = 0; g < project.groups.size(); ++g)
    for (std::size_t i = 0; i < project.groups[g].layers.size(); ++i)
      add_layer(layers, project.groups[g].layers[i], id_of(g, i), crs);
  add_properties(root, !crs.empty());
  add_times(root, project);
  if (project.layout) add_print_layout(root.add("Layouts"), *project.layout, project.view, shown_layers(project));
  write_text(file, document.text(qgis_doctype));
}

}  // namespace talus
