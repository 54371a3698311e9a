// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What [slides] lists, and which part of the model each slide gets.
#include "preprocess/slides/slides.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/error.hpp"
#include "common/gis/geotiff.hpp"
#include "common/map/crop.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "tests/common/scratch.hpp"

namespace talus::preprocess {
namespace {

/// A model of 120 x 80 cells of 10 m whose heights follow a profile across x, and outlines on it.
struct ManySlides {
  test::Scratch scratch;
  MapGrid grid{
      .columns = 120, .rows = 80, .west = 500000, .south = 5100000, .cell = 10, .crs_wkt = metric_crs("EPSG:32632")};

  explicit ManySlides(const std::function<double(double)>& profile = [](double x) { return 900 - 0.5 * x; }) {
    Raster model{grid, {}};
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) model.values.push_back(profile(grid.x(column) - grid.west));
    write_geotiff(scratch / "model.tif", model, {});
  }

  /// A square of 40 m as a feature, its south-west corner [m from the model's].
  static std::string feature(double x, double y, const std::string& properties) {
    std::string ring;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {40, 0}, {40, 40}, {0, 40}, {0, 0}})
      ring += fmt::format("{}[{},{}]", ring.empty() ? "" : ",", 500000 + x + dx, 5100000 + y + dy);
    return fmt::format(
        R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"Polygon","coordinates":[[{}]]}}}})", properties,
        ring);
  }
  void outlines(const std::vector<std::string>& features) const {
    std::string text =
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},)"
        R"("features":[)";
    for (std::size_t n = 0; n < features.size(); ++n) text += (n > 0 ? "," : "") + features[n];
    scratch.write("areas.geojson", text + "]}");
  }
  recipe::Recipe recipe(const std::string& slides, const std::string& preprocess = "base_dem = \"model.tif\"") const {
    return recipe::Recipe(scratch.write("recipe.toml", "[preprocess]\n" + preprocess + "\n[slides]\n" + slides));
  }
  static EnsemblePlan plan(const recipe::Recipe& recipe) {
    const SlideOptions options = slides_of(recipe);
    const ModelIs model = model_of(recipe);
    const Options shared = shared_options(recipe, options);
    const auto slides = list_slides(options, model, metric_crs("EPSG:32632"));
    return plan_of(recipe, slides, windows_of(slides, options, shared), model);
  }
  static std::string fault(const recipe::Recipe& recipe) {
    try {
      plan(recipe);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

/// Lines of [slides]: the outlines, and keys of the recipe that take an attribute each.
std::string with_set(const std::vector<std::pair<std::string, std::string>>& keys) {
  std::string set;
  for (const auto& [key, attribute] : keys)
    set += fmt::format("{}{{key = \"{}\", attribute = \"{}\"}}", set.empty() ? "" : ", ", key, attribute);
  return fmt::format("outlines = \"areas.geojson\"\nname_from = \"name\"\nset = [{}]\n", set);
}

const std::string by_depth = with_set({{thickness_key, "depth"}});

TEST(Slides, get_the_rectangle_around_their_outline_and_a_margin_in_whole_cells) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)"),
                 ManySlides::feature(505, 405, R"("name":"b","depth":3)")});
  const EnsemblePlan plan = ManySlides::plan(many.recipe(by_depth + "margin_m = 95.0\n"));
  const SlideTable& slides = *plan.table.slides;
  EXPECT_EQ(plan.table.names, (std::vector<std::string>{"a", "b"}));
  // a: columns 30 to 33 and ten around; b lies half a cell off, and touches five.
  EXPECT_EQ(slides.lattice.west, 500200);
  EXPECT_EQ(slides.lattice.south, 5100100);
  EXPECT_EQ(slides.windows[0].column, 0);
  EXPECT_EQ(slides.windows[0].columns, 25) << "a right edge on the border of two cells touches both";
  EXPECT_EQ(slides.windows[1].column, 20);
  EXPECT_EQ(slides.windows[1].row, 20);
  EXPECT_EQ(slides.windows[1].columns, 25);
  EXPECT_EQ(plan.table.columns[0].key, "preprocess.release[0].thickness_m");
  EXPECT_EQ(plan.table.columns[0].values, (std::vector<double>{2, 3}));
}

TEST(Slides, are_what_a_recipe_of_one_of_them_makes) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)"),
                 ManySlides::feature(505, 405, R"("name":"b","depth":3)")});
  EnsemblePlan plan = ManySlides::plan(many.recipe(by_depth + "margin_m = 95.0\n"));
  const MapGrid window = cut(plan.table.slides->lattice, plan.table.slides->windows[1]);
  const auto alone = recipe::Recipe(many.scratch.write(
      "alone.toml",
      fmt::format("[preprocess]\nbase_dem = \"model.tif\"\n[preprocess.grid]\nextent_m = [{}, {}, {}, {}]\n"
                  "[[preprocess.release]]\n"
                  "polygons = \"areas.geojson|subset=name = 'b'\"\nthickness_m = 3.0\n",
                  window.west, window.south, window.east(), window.north())));
  const Domain one = prepare(*plan.ground[1], Points::seeded).domain,
               other = prepare(alone.read<Options>("preprocess"), Points::seeded).domain;
  EXPECT_EQ(one.terrain.values, other.terrain.values);
  EXPECT_EQ(one.release_thickness.values, other.release_thickness.values);
  EXPECT_EQ(one.points.x, other.points.x);
  EXPECT_EQ(one.points.volume, other.points.volume);
  EXPECT_GT(one.points.volume.size(), 0u);
}

TEST(Slides, of_a_thickness_have_the_volume_of_their_area_times_it) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":3)")});
  const EnsemblePlan plan = ManySlides::plan(many.recipe(by_depth + "margin_m = 100.0\n"));
  const Prepared made = prepare(*plan.ground[0], Points::counted);
  EXPECT_NEAR(made.total.volume, 4800, 1e-9 * 4800);
}

TEST(Slides, of_a_volume_have_it) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","v":7000)")});
  const EnsemblePlan plan = ManySlides::plan(many.recipe(with_set({{volume_key, "v"}}) + "margin_m = 100.0\n"));
  const Prepared made = prepare(*plan.ground[0], Points::counted);
  EXPECT_NEAR(made.total.volume, 7000, 1e-9 * 7000);
}

TEST(Slides, are_cut_out_of_the_model_by_depth_where_it_is_the_surface_before) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","d":4)")});
  const EnsemblePlan plan = ManySlides::plan(
      many.recipe(with_set({{cut_keys[0], "d"}}) + "margin_m = 100.0\n", "before_dem = \"model.tif\""));
  const Domain made = prepare(*plan.ground[0], Points::counted).domain;
  double deepest = 0;
  for (const double thickness : made.release_thickness.values) deepest = std::max(deepest, thickness);
  EXPECT_NEAR(deepest, 4, 1e-6);
}

TEST(Slides, that_say_what_the_model_cannot_take_are_refused) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)")});
  const std::string cut = ManySlides::fault(many.recipe(with_set({{cut_keys[1], "depth"}}) + "margin_m = 50.0\n"));
  EXPECT_NE(cut.find("sliding_surface.volume_m3, with base_dem"), std::string::npos) << cut;
  const std::string laid = ManySlides::fault(many.recipe(by_depth, "before_dem = \"model.tif\""));
  EXPECT_NE(laid.find("release[0].thickness_m, with before_dem"), std::string::npos) << laid;
  const std::string none = ManySlides::fault(many.recipe(with_set({})));
  EXPECT_NE(none.find("feature 0: no thickness"), std::string::npos) << none;
}

/// Down at 30 degrees from x = 300 m to 500 m, then level: the line of 11 degrees meets the level 2 tan 30 / tan 11
/// from the outline's edge at x = 300 m, less the height that the outline itself takes.
TEST(Slides, get_all_ground_below_the_line_of_reach_where_no_margin_is_given) {
  const double slope = std::tan(M_PI / 6);
  const ManySlides many([&](double x) { return 1000 - slope * std::clamp(x - 300, 0.0, 200.0); });
  many.outlines({ManySlides::feature(260, 400, R"("name":"a","depth":2)")});
  const EnsemblePlan plan = ManySlides::plan(many.recipe(by_depth));
  const SlideTable& slides = *plan.table.slides;
  const MapGrid window = cut(slides.lattice, slides.windows[0]);
  // The outline touches columns 26 to 30, so distances count from x = 310 m; rim of three cells.
  const double reach = 310 + 200 * slope / std::tan(11 * M_PI / 180) + 30;
  EXPECT_NEAR(window.east(), 500000 + reach, 10) << "to a cell";
  EXPECT_NEAR(window.west, 500000 + 260 - 30, 1e-6) << "level ground behind it is not below the line";
}

TEST(Slides, are_refused_with_their_place_and_all_at_once) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)"),
                 ManySlides::feature(500, 200, R"("name":"a","depth":null)"),
                 ManySlides::feature(700, 200, R"("name":"c","depth":-1)")});
  const std::string text = ManySlides::fault(many.recipe(by_depth + "margin_m = 50.0\n"));
  EXPECT_NE(text.find("feature 1: attribute depth is NULL"), std::string::npos) << text;
  EXPECT_NE(text.find("feature 2: depth = -1"), std::string::npos) << text;
  EXPECT_NE(text.find("name \"a\" is taken by"), std::string::npos) << text;
  const std::string missing = ManySlides::fault(many.recipe(with_set({{thickness_key, "t"}})));
  EXPECT_NE(missing.find("no attribute t (it has name, depth)"), std::string::npos) << missing;
}

TEST(Slides, beyond_the_model_are_refused_by_name) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)"),
                 ManySlides::feature(1180, 200, R"("name":"b","depth":2)")});
  const std::string text = ManySlides::fault(many.recipe(by_depth + "margin_m = 50.0\n"));
  EXPECT_NE(text.find("feature 1 (b): its outline reaches beyond"), std::string::npos) << text;
}

TEST(Slides, without_a_polygon_are_refused) {
  const ManySlides many;
  many.outlines({});
  const std::string none = ManySlides::fault(many.recipe(by_depth));
  EXPECT_NE(none.find("no feature"), std::string::npos) << none;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)")});
  std::string some = by_depth;
  some.insert(some.find(".geojson") + 8, "|subset=depth > 5");
  const std::string filtered = ManySlides::fault(many.recipe(some));
  EXPECT_NE(filtered.find("no feature whose attributes meet depth > 5"), std::string::npos) << filtered;
}

TEST(Slides, take_no_keys_that_are_theirs_and_no_value_twice) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)")});
  const std::string own =
      ManySlides::fault(many.recipe(with_set({{thickness_key, "depth"}, {"preprocess.release[0].grow_m", "depth"}})));
  EXPECT_NE(own.find("cannot be set by an attribute"), std::string::npos) << own;
  const std::string grid =
      ManySlides::fault(many.recipe(with_set({{thickness_key, "depth"}, {"preprocess.grid.spacing_m", "depth"}})));
  EXPECT_NE(grid.find("preprocess.grid.spacing_m cannot vary"), std::string::npos) << grid;
  const std::string besides = ManySlides::fault(
      many.recipe(by_depth, "base_dem = \"model.tif\"\ngrid.extent_m = [500000.0, 5e6, 500100.0, 5.1e6]"));
  EXPECT_NE(besides.find("extent_m beside [slides]"), std::string::npos) << besides;
  const std::string places = ManySlides::fault(
      many.recipe(by_depth, "base_dem = \"model.tif\"\nplace = [{name = \"set\", file = \"lines.gpkg\"}]"));
  EXPECT_NE(places.find("place beside [slides]"), std::string::npos) << places;
}

TEST(Slides, that_are_listed_choose_their_outline_and_set_values) {
  const ManySlides many;
  many.outlines({ManySlides::feature(300, 200, R"("name":"a","depth":2)"),
                 ManySlides::feature(505, 405, R"("name":"b","depth":3)")});
  const auto recipe = many.recipe(
      "margin_m = 50.0\n"
      "[[slides.scenario]]\nname = \"soft\"\noutline = \"areas.geojson|subset=name = 'b'\"\n"
      "set = [\"preprocess.release[0].thickness_m = 2.5\", \"solve.base.friction_angle_deg = 14\"]\n"
      "[[slides.scenario]]\nname = \"stiff\"\noutline = \"areas.geojson|subset=name = 'b'\"\n"
      "set = [\"preprocess.release[0].thickness_m = 2.5\", \"solve.base.friction_angle_deg = 24\"]\n");
  const EnsemblePlan plan = ManySlides::plan(recipe);
  EXPECT_EQ(plan.table.names, (std::vector<std::string>{"soft", "stiff"}));
  EXPECT_EQ(plan.table.find("solve.base.friction_angle_deg")->values, (std::vector<double>{14, 24}));
  EXPECT_EQ(plan.table.values_of(1, "solve."), (std::vector<std::string>{"solve.base.friction_angle_deg=24"}));
  EXPECT_EQ(plan.table.slides->windows[0].column, plan.table.slides->windows[1].column);
  EXPECT_NE(ManySlides::fault(many.recipe("outlines = \"areas.geojson\"\n[[slides.scenario]]\nname = \"soft\"\n"))
                .find("[[slides.scenario]] soft has no outline"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
