// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Styles and the project for QGIS: their classes, and the files as XML documents.
#include <cmath>
#include <map>
#include <set>

#include "common/qgis/project.hpp"
#include "common/qgis/style.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::parsed;

struct Item {
  std::string value, colour, label;
};

std::vector<Item> items_of(const test::XmlDocument& document) {
  std::vector<Item> items;
  CPLXMLNode* shader = CPLGetXMLNode(document.get(), "=qgis.pipe.rasterrenderer.rastershader.colorrampshader");
  for (CPLXMLNode* node = shader != nullptr ? shader->psChild : nullptr; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element || std::string(node->pszValue) != "item") continue;
    items.push_back(
        {CPLGetXMLValue(node, "value", ""), CPLGetXMLValue(node, "color", ""), CPLGetXMLValue(node, "label", "")});
  }
  return items;
}

/// Lightness of a colour in OKLab (Ottosson 2020), 0 black to 1 white.
double oklab_lightness(const Colour& colour) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  const double r = linear(colour.r), g = linear(colour.g), b = linear(colour.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

using QgisStyle = test::InScratch;

TEST_F(QgisStyle, lists_classes_by_their_upper_ends_with_unit) {
  const auto file = write_qgis_style(scratch / "deposit.tif", class_style({0.1, 5, 10}, "m"));
  EXPECT_EQ(file, scratch / "deposit.qml");
  const auto document = parsed(file);
  const auto items = items_of(document);
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items[0].value, "5");
  EXPECT_EQ(items[0].label, "0.1 \u2013 5 m");
  EXPECT_EQ(items[2].value, "inf");
  EXPECT_EQ(items[2].label, "> 10 m");
  EXPECT_EQ(items[1].colour, hex(class_colour(1, 3))) << "the colours of the picture";
  const auto* renderer = CPLGetXMLNode(document.get(), "=qgis.pipe.rasterrenderer");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "type", ""), "singlebandpseudocolor");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "rastershader.colorrampshader.colorRampType", ""), "DISCRETE");
}

TEST_F(QgisStyle, hides_what_lies_below_the_first_class_and_lights_a_terrain_from_several_sides) {
  const auto document = parsed(write_qgis_style(scratch / "a.tif", class_style({0.1, 5}, "m")));
  const auto* hidden =
      CPLGetXMLNode(document.get(), "=qgis.pipe.rasterrenderer.rasterTransparency.singleValuePixelList.pixelListEntry");
  ASSERT_NE(hidden, nullptr);
  EXPECT_LT(std::stod(CPLGetXMLValue(hidden, "min", "")), -1e30);
  EXPECT_STREQ(CPLGetXMLValue(hidden, "max", ""), "0.1");
  EXPECT_STREQ(CPLGetXMLValue(hidden, "percentTransparent", ""), "100");
  const auto terrain = parsed(write_qgis_hillshade_style(scratch / "terrain.tif"));
  const auto* renderer = CPLGetXMLNode(terrain.get(), "=qgis.pipe.rasterrenderer");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "type", ""), "hillshade");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "multidirection", ""), "1");
}

TEST_F(QgisStyle, of_a_time_draws_everything_and_the_early_darkest) {
  const auto style = time_style({10, 20}, "s");
  ASSERT_EQ(style.classes.size(), 3U);
  EXPECT_EQ(style.hidden_from, style.hidden_to);
  EXPECT_EQ(style.classes[0].label, "< 10 s");
  EXPECT_EQ(style.classes[1].label, "10 \u2013 20 s");
  EXPECT_LT(oklab_lightness(style.classes[0].colour), oklab_lightness(style.classes[2].colour));
}

TEST_F(QgisStyle, of_a_difference_is_symmetric_blue_to_red) {
  const auto style = difference_style({1, 5, 20}, "m");
  ASSERT_EQ(style.classes.size(), 6U);
  EXPECT_EQ(style.hidden_from, -1);
  EXPECT_EQ(style.hidden_to, 1);
  const std::vector<double> uppers{-20, -5, -1, 5, 20, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(style.classes[i].upper, uppers[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &loss = style.classes[i].colour, &gain = style.classes[5 - i].colour;
    EXPECT_GT(loss.b, loss.r) << i;
    EXPECT_GT(gain.r, gain.b) << i;
    // The same weight to the eye on both sides; a hundredth of the scale is not seen.
    EXPECT_NEAR(oklab_lightness(loss), oklab_lightness(gain), 0.01) << i;
  }
  EXPECT_EQ(style.classes[0].label, "< \u221220 m");
  EXPECT_EQ(style.classes[2].label, "\u22125 \u2013 \u22121 m");
  EXPECT_EQ(style.classes[5].label, "> +20 m");
  EXPECT_EQ(style.classes[3].label, "+1 \u2013 +5 m");
}

TEST(Colours, keep_their_order_in_every_ramp) {
  for (const Ramp ramp : {Ramp::heat, Ramp::sea})
    for (std::size_t i = 0; i + 1 < 6; ++i) {
      const double step = oklab_lightness(class_colour(i, 6, ramp)) - oklab_lightness(class_colour(i + 1, 6, ramp));
      EXPECT_NEAR(step, ramp == Ramp::heat ? 0.68 / 5 : 0.60 / 5, 0.02)
          << "between class " << i << " and the next: equal steps must look equal";
    }
}

TEST_F(QgisStyle, escapes_what_xml_would_misread_and_is_named_where_it_cannot_be_written) {
  const auto document = parsed(write_qgis_style(scratch / "a.tif", class_style({1}, "m \"<&>")));
  EXPECT_EQ(items_of(document).at(0).label, "> 1 m \"<&>");
  const auto fault = data_fault([&] { write_qgis_style(scratch / "none/a.tif", class_style({1}, "m")); });
  EXPECT_TRUE(test::holds(fault, {"a.qml: cannot be written"}));
}

QgisProject sample() {
  QgisProject project{"Slide & \"debris\"", test::epsg(32611), {500000, 5400000, 500400, 5400300}, {}};
  project.groups.push_back({"Outlines", {{"Deposit", "outlines.gpkg|layername=deposit", true, OutlineStyle{}}}});
  project.groups.push_back({"Maps",
                            {{"Thickness", "deposit_thickness.tif", true, class_style({1, 5}, "m")},
                             {"Speed", "peak_speed.tif", false, class_style({1, 5}, "m/s")}}});
  project.groups.push_back({"Ground", {{"Terrain", "terrain.tif", true, HillshadeStyle{}}}});
  return project;
}

struct ProjectFile : test::InScratch {
  ProjectFile() : file_(scratch / "slide.qgs") { read(sample()); }
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

  std::filesystem::path file_;
  test::XmlDocument document_;
};

TEST_F(ProjectFile, names_title_crs_and_what_is_seen_first_and_projects_nothing_without_crs) {
  EXPECT_EQ(value("=qgis.title"), "Slide & \"debris\"");
  EXPECT_EQ(value("=qgis.projectCrs.spatialrefsys.authid"), "EPSG:32611");
  EXPECT_EQ(value("=qgis.mapcanvas.extent.xmin"), "500000");
  EXPECT_EQ(value("=qgis.mapcanvas.extent.ymax"), "5400300");
  EXPECT_EQ(value("=qgis.ProjectViewSettings.DefaultViewExtent.xmax"), "500400");
  EXPECT_EQ(value("=qgis.properties.Paths.Absolute"), "false");
  auto project = sample();
  project.crs_wkt.clear();
  read(project);
  EXPECT_EQ(value("=qgis.projectCrs.spatialrefsys.authid"), "none");
  EXPECT_EQ(value("=qgis.properties.SpatialRefSys.ProjectionsEnabled"), "0");
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
