// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A project of QGIS as an XML document: what stands in it, and what QGIS asks of it.
#include "common/qgis/project.hpp"

#include <map>
#include <set>

#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"
#include "tests/common/xml.hpp"

namespace talus {
namespace {

using test::Scratch;

QgisProject sample() {
  QgisProject project{"Slide & \"debris\"", test::epsg(32611), {500000, 5400000, 500400, 5400300}, {}};
  project.groups.push_back({"Outlines", {{"Deposit", "outlines.gpkg|layername=deposit", true, OutlineStyle{}}}});
  project.groups.push_back({"Maps",
                            {{"Thickness", "deposit_thickness.tif", true, class_style({1, 5}, "m")},
                             {"Speed", "peak_speed.tif", false, class_style({1, 5}, "m/s")}}});
  project.groups.push_back({"Ground", {{"Terrain", "terrain.tif", true, HillshadeStyle{}}}});
  return project;
}

class ProjectFile : public ::testing::Test {
 protected:
  ProjectFile() : file_(scratch_ / "slide.qgs") { read(sample()); }
  void read(const QgisProject& project) {
    write_qgis_project(file_, project);
    document_ = test::parsed(file_);
  }
  std::string value(const char* path) const { return CPLGetXMLValue(document_.get(), path, "none"); }
  /// Elements `name` directly inside the one at `path`.
  std::vector<const CPLXMLNode*> elements(const CPLXMLNode* parent, const std::string& name) const {
    std::vector<const CPLXMLNode*> found;
    for (const CPLXMLNode* node = parent != nullptr ? parent->psChild : nullptr; node != nullptr; node = node->psNext)
      if (node->eType == CXT_Element && name == node->pszValue) found.push_back(node);
    return found;
  }
  const CPLXMLNode* at(const char* path) const { return CPLGetXMLNode(document_.get(), path); }

  Scratch scratch_;
  std::filesystem::path file_;
  test::XmlDocument document_;
};

TEST_F(ProjectFile, names_title_crs_and_what_is_seen_first) {
  EXPECT_EQ(value("=qgis.title"), "Slide & \"debris\"");
  EXPECT_EQ(value("=qgis.projectCrs.spatialrefsys.authid"), "EPSG:32611");
  EXPECT_EQ(value("=qgis.mapcanvas.extent.xmin"), "500000");
  EXPECT_EQ(value("=qgis.mapcanvas.extent.ymax"), "5400300");
  EXPECT_EQ(value("=qgis.ProjectViewSettings.DefaultViewExtent.xmax"), "500400");
  EXPECT_EQ(value("=qgis.properties.Paths.Absolute"), "false");
}

TEST_F(ProjectFile, holds_every_layer_of_its_tree_by_a_relative_path) {
  std::set<std::string> in_tree, in_layers;
  for (const auto* group : elements(at("=qgis.layer-tree-group"), "layer-tree-group"))
    for (const auto* layer : elements(group, "layer-tree-layer")) in_tree.insert(CPLGetXMLValue(layer, "id", ""));
  for (const auto* layer : elements(at("=qgis.projectlayers"), "maplayer")) {
    const std::string id = CPLGetXMLValue(layer, "id", "");
    EXPECT_GT(id.size(), 10U) << "QGIS replaces shorter ones, and the tree finds nothing";
    in_layers.insert(id);
    EXPECT_TRUE(std::string(CPLGetXMLValue(layer, "datasource", "")).starts_with("./"));
    EXPECT_STREQ(CPLGetXMLValue(layer, "srs.spatialrefsys.authid", ""), "EPSG:32611");
  }
  EXPECT_EQ(in_tree.size(), 4U);
  EXPECT_EQ(in_tree, in_layers);
}

TEST_F(ProjectFile, draws_each_layer_in_its_style) {
  const auto layers = elements(at("=qgis.projectlayers"), "maplayer");
  ASSERT_EQ(layers.size(), 4U);
  EXPECT_STREQ(CPLGetXMLValue(layers[0], "provider", ""), "ogr");
  EXPECT_STREQ(CPLGetXMLValue(layers[0], "renderer-v2.symbols.symbol.layer.class", ""), "SimpleFill");
  EXPECT_STREQ(CPLGetXMLValue(layers[1], "pipe.rasterrenderer.type", ""), "singlebandpseudocolor");
  EXPECT_STREQ(CPLGetXMLValue(layers[3], "pipe.rasterrenderer.type", ""), "hillshade");
  const auto groups = elements(at("=qgis.layer-tree-group"), "layer-tree-group");
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_STREQ(CPLGetXMLValue(elements(groups[1], "layer-tree-layer").at(1), "checked", ""), "Qt::Unchecked");
}

TEST_F(ProjectFile, without_crs_projects_nothing) {
  auto project = sample();
  project.crs_wkt.clear();
  read(project);
  EXPECT_EQ(value("=qgis.projectCrs.spatialrefsys.authid"), "none");
  EXPECT_EQ(value("=qgis.properties.SpatialRefSys.ProjectionsEnabled"), "0");
}

TEST_F(ProjectFile, shows_frames_one_after_the_other) {
  auto project = sample();
  RasterStyle second = class_style({1, 5}, "m");
  second.band = 2;
  project.groups.push_back({"Flow",
                            {{"0 s", "NETCDF:\"r.nc\":h", true, class_style({1, 5}, "m"),
                              ProjectTime{"1903-04-29T04:10:00.000Z", "1903-04-29T04:10:00.500Z"}},
                             {"0.5 s", "NETCDF:\"r.nc\":h", true, second,
                              ProjectTime{"1903-04-29T04:10:00.500Z", "1903-04-29T04:10:01.000Z"}}},
                            false});
  read(project);
  const auto layers = elements(at("=qgis.projectlayers"), "maplayer");
  ASSERT_EQ(layers.size(), 6U);
  EXPECT_STREQ(CPLGetXMLValue(layers[5], "datasource", ""), "NETCDF:\"./r.nc\":h") << "as QGIS finds the file in it";
  EXPECT_STREQ(CPLGetXMLValue(layers[5], "pipe.rasterrenderer.band", ""), "2");
  EXPECT_STREQ(CPLGetXMLValue(layers[5], "temporal.fixedRange.start", ""), "1903-04-29T04:10:00.500Z");
  EXPECT_EQ(CPLGetXMLNode(layers[1], "temporal"), nullptr) << "a map of the end has no time";
  EXPECT_EQ(value("=qgis.ProjectTimeSettings.TemporalRange.start"), "1903-04-29T04:10:00.000Z");
  EXPECT_EQ(value("=qgis.ProjectTimeSettings.TemporalRange.end"), "1903-04-29T04:10:01.000Z");
  const auto groups = elements(at("=qgis.layer-tree-group"), "layer-tree-group");
  EXPECT_STREQ(CPLGetXMLValue(groups.back(), "checked", ""), "Qt::Unchecked");
}

TEST_F(ProjectFile, has_a_page_to_print_with_what_is_shown) {
  EXPECT_EQ(at("=qgis.Layouts"), nullptr);
  auto project = sample();
  project.layout = PrintLayout{.title = "Slide [% env('HOME') %]", .subtitle = "s", .sources = "t"};
  read(project);
  std::map<std::string, const CPLXMLNode*> items;
  for (const auto* item : elements(at("=qgis.Layouts.Layout"), "LayoutItem"))
    items[CPLGetXMLValue(item, "id", "")] = item;
  for (const char* name : {"Map", "Title", "Subtitle", "Sources", "Legend", "Scale bar", "North arrow"})
    EXPECT_TRUE(items.contains(name)) << name;
  EXPECT_STREQ(CPLGetXMLValue(items["Title"], "labelText", ""), "Slide [ % env('HOME') %]") << "no formula is run";
  EXPECT_STREQ(CPLGetXMLValue(items["Scale bar"], "mapUuid", ""), CPLGetXMLValue(items["Map"], "uuid", "x"));
  const double width = CPLAtof(CPLGetXMLValue(items["Map"], "Extent.xmax", "")) -
                       CPLAtof(CPLGetXMLValue(items["Map"], "Extent.xmin", ""));
  const double height = CPLAtof(CPLGetXMLValue(items["Map"], "Extent.ymax", "")) -
                        CPLAtof(CPLGetXMLValue(items["Map"], "Extent.ymin", ""));
  EXPECT_NEAR(height, 300, 70) << "the whole view is on it";
  EXPECT_GE(width, 400);
  EXPECT_NEAR(width / height, 205.0 / 166, 1e-9) << "what QGIS would stretch it to otherwise";
  std::vector<std::string> listed;
  for (const auto* layer : elements(CPLGetXMLNode(items["Legend"], "layer-tree-group"), "layer-tree-layer"))
    listed.emplace_back(CPLGetXMLValue(layer, "name", ""));
  EXPECT_EQ(listed, (std::vector<std::string>{"Deposit", "Thickness"})) << "neither hidden layers nor the ground";
}

TEST(PrintPage, has_a_round_scale_bar_and_names_that_stay_on_it) {
  EXPECT_EQ(scale_bar_segment(400), 50);
  EXPECT_EQ(scale_bar_segment(8000), 1000);
  for (int n = 0; n < 49; ++n) {
    const double width = 3 * std::pow(1.3, n);  // to 1e6
    EXPECT_LE(2 * scale_bar_segment(width), width / 4 * (1 + 1e-12));
    EXPECT_GT(2 * scale_bar_segment(width), width / 11);
  }
  EXPECT_EQ(in_lines("Deposit", 10), "Deposit");
  EXPECT_EQ(in_lines("Deposit of the slide", 10), std::string("Deposit of") + line_break + "the slide");
  EXPECT_EQ(in_lines("abcdefghijklm no", 10), std::string("abcdefghij") + line_break + "klm no");
  EXPECT_EQ(in_lines("", 10), "");
}

}  // namespace
}  // namespace talus
