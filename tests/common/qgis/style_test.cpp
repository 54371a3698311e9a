// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Styles for QGIS: the classes, and the file as an XML document.
#include "common/qgis/style.hpp"

#include "tests/common/scratch.hpp"
#include "tests/common/xml.hpp"

namespace talus {
namespace {

using test::parsed;
using test::Scratch;

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

TEST(QgisStyle, lists_classes_by_their_upper_ends_with_unit) {
  const Scratch scratch;
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

TEST(QgisStyle, hides_what_lies_below_the_first_class) {
  const Scratch scratch;
  const auto document = parsed(write_qgis_style(scratch / "a.tif", class_style({0.1, 5}, "m")));
  const auto* hidden =
      CPLGetXMLNode(document.get(), "=qgis.pipe.rasterrenderer.rasterTransparency.singleValuePixelList.pixelListEntry");
  ASSERT_NE(hidden, nullptr);
  EXPECT_LT(std::stod(CPLGetXMLValue(hidden, "min", "")), -1e30);
  EXPECT_STREQ(CPLGetXMLValue(hidden, "max", ""), "0.1");
  EXPECT_STREQ(CPLGetXMLValue(hidden, "percentTransparent", ""), "100");
}

TEST(QgisStyle, of_a_time_draws_everything_and_the_early_darkest) {
  const auto style = time_style({10, 20}, "s");
  ASSERT_EQ(style.classes.size(), 3U);
  EXPECT_EQ(style.hidden_from, style.hidden_to);
  EXPECT_EQ(style.classes[0].label, "< 10 s");
  EXPECT_EQ(style.classes[1].label, "10 \u2013 20 s");
  EXPECT_LT(oklab_lightness(style.classes[0].colour), oklab_lightness(style.classes[2].colour));
}

TEST(QgisStyle, of_a_difference_is_symmetric_blue_to_red) {
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

TEST(QgisStyle, of_a_terrain_is_a_hillshade_lit_from_several_sides) {
  const Scratch scratch;
  const auto document = parsed(write_qgis_hillshade_style(scratch / "terrain.tif"));
  const auto* renderer = CPLGetXMLNode(document.get(), "=qgis.pipe.rasterrenderer");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "type", ""), "hillshade");
  EXPECT_STREQ(CPLGetXMLValue(renderer, "multidirection", ""), "1");
}

TEST(QgisStyle, escapes_what_xml_would_misread) {
  const Scratch scratch;
  const auto document = parsed(write_qgis_style(scratch / "a.tif", class_style({1}, "m \"<&>")));
  EXPECT_EQ(items_of(document).at(0).label, "> 1 m \"<&>");
}

TEST(QgisStyle, that_cannot_be_written_is_named) {
  const Scratch scratch;
  const auto fault =
      test::fault_of<DataError>([&] { write_qgis_style(scratch / "none/a.tif", class_style({1}, "m")); });
  EXPECT_TRUE(test::holds(fault, {"a.qml: cannot be written"}));
}

}  // namespace
}  // namespace talus
