// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A project of QGIS as an XML document: what stands in it, and what QGIS asks of it.
#include "common/qgis/project.hpp"

#include <gtest/gtest.h>

#include <set>

#include "common/error.hpp"
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

}  // namespace
}  // namespace talus
