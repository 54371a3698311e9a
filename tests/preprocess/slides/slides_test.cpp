// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What [slides] lists, and which part of the model each slide gets.
#include "preprocess/slides/slides.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/gis/geotiff.hpp"
#include "common/map/raster.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "tests/common/geojson.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

using test::holds;

/// A model of 120 x 80 cells of 10 m whose heights follow a profile across x, and outlines on it.
struct Slides : test::InScratch {
  MapGrid grid{
      .columns = 120, .rows = 80, .west = 500000, .south = 5100000, .cell = 10, .crs_wkt = metric_crs("EPSG:32632")};

  Slides() {
    write_model([](double x) { return 900 - 0.5 * x; });
  }
  void write_model(const std::function<double(double)>& profile) const {
    test::write(scratch, "model.tif", test::raster_of(grid, [&](double x, double) { return profile(x - grid.west); }));
  }

  /// A square of 40 m as a feature, its south-west corner [m from the model's].
  static std::string slide(double x, double y, const std::string& properties) {
    std::string ring;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {40, 0}, {40, 40}, {0, 40}, {0, 0}})
      ring += fmt::format("{}[{},{}]", ring.empty() ? "" : ",", 500000 + x + dx, 5100000 + y + dy);
    return test::feature("Polygon", "[[" + ring + "]]", "{" + properties + "}");
  }
  void outlines(const std::vector<std::string>& features) const {
    std::string text;
    for (std::size_t n = 0; n < features.size(); ++n) text += (n > 0 ? "," : "") + features[n];
    scratch.write("areas.geojson", test::geojson(text, 32632));
  }
  EnsemblePlan planned(const std::string& slide_keys, const std::string& keys = "base_dem = \"model.tif\"") const {
    const recipe::Recipe recipe(scratch.write("recipe.toml", "[preprocess]\n" + keys + "\n[slides]\n" + slide_keys));
    const SlideOptions options = slides_of(recipe);
    const ModelIs model = model_of(recipe);
    const Options shared = shared_options(recipe, options);
    const auto slides = list_slides(options, model, metric_crs("EPSG:32632"));
    return plan_of(recipe, slides, windows_of(slides, options, shared), model);
  }
  template <class... Keys>
  std::string fault(const Keys&... keys) const {
    return test::fault_of<Error>([&] { planned(keys...); });
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

TEST_F(Slides, get_the_rectangle_around_their_outline_and_a_margin_in_whole_cells) {
  outlines({slide(300, 200, R"("name":"a","depth":2)"), slide(505, 405, R"("name":"b","depth":3)")});
  const EnsemblePlan plan = planned(by_depth + "margin_m = 95.0\n");
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

TEST_F(Slides, are_what_a_recipe_of_one_of_them_makes) {
  outlines({slide(300, 200, R"("name":"a","depth":2)"), slide(505, 405, R"("name":"b","depth":3)")});
  EnsemblePlan plan = planned(by_depth + "margin_m = 95.0\n");
  const MapGrid window = cut(plan.table.slides->lattice, plan.table.slides->windows[1]);
  const auto alone = recipe::Recipe(scratch.write(
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

TEST_F(Slides, have_the_thickness_volume_or_depth_of_their_attribute) {
  outlines({slide(300, 200, R"("name":"a","depth":3,"v":7000,"d":4)")});
  const auto made = [&](const std::string& key, const std::string& attribute, const std::string& model) {
    const std::string keys = with_set({{key, attribute}}) + "margin_m = 100.0\n";
    return prepare(*planned(keys, model + " = \"model.tif\"").ground[0], Points::counted);
  };
  EXPECT_NEAR(made(thickness_key, "depth", "base_dem").total.volume, 4800, 1e-9 * 4800) << "area times it";
  EXPECT_NEAR(made(volume_key, "v", "base_dem").total.volume, 7000, 1e-9 * 7000);
  const Domain cut_out = made(cut_keys[0], "d", "before_dem").domain;
  EXPECT_NEAR(std::ranges::max(cut_out.release_thickness.values), 4, 1e-6) << "out of the surface before";
}

TEST_F(Slides, that_say_what_the_model_cannot_take_or_a_value_twice_are_refused) {
  outlines({slide(300, 200, R"("name":"a","depth":2)")});
  EXPECT_TRUE(holds(fault(with_set({{cut_keys[1], "depth"}}) + "margin_m = 50.0\n"),
                    {"sliding_surface.volume_m3, with base_dem"}));
  EXPECT_TRUE(holds(fault(by_depth, "before_dem = \"model.tif\""), {"release[0].thickness_m, with before_dem"}));
  EXPECT_TRUE(holds(fault(with_set({})), {"feature 0: no thickness"}));
  const std::string own = fault(with_set({{thickness_key, "depth"}, {"preprocess.release[0].grow_m", "depth"}}));
  EXPECT_TRUE(holds(own, {"cannot be set by an attribute"}));
  const std::string grid = fault(with_set({{thickness_key, "depth"}, {"preprocess.grid.spacing_m", "depth"}}));
  EXPECT_TRUE(holds(grid, {"preprocess.grid.spacing_m cannot vary"}));
  EXPECT_TRUE(holds(fault(by_depth, "base_dem = \"model.tif\"\ngrid.extent_m = [500000.0, 5e6, 500100.0, 5.1e6]"),
                    {"extent_m beside [slides]"}));
  EXPECT_TRUE(holds(fault(by_depth, "base_dem = \"model.tif\"\nplace = [{name = \"set\", file = \"lines.gpkg\"}]"),
                    {"place beside [slides]"}));
}

/// Down at 30 degrees from x = 300 m to 500 m, then level: the line of 11 degrees meets the level 2 tan 30 / tan 11
/// from the outline's edge at x = 300 m, less the height that the outline itself takes.
TEST_F(Slides, get_all_ground_below_the_line_of_reach_where_no_margin_is_given) {
  const double slope = std::tan(M_PI / 6);
  write_model([&](double x) { return 1000 - slope * std::clamp(x - 300, 0.0, 200.0); });
  outlines({slide(260, 400, R"("name":"a","depth":2)")});
  const EnsemblePlan plan = planned(by_depth);
  const SlideTable& slides = *plan.table.slides;
  const MapGrid window = cut(slides.lattice, slides.windows[0]);
  // The outline touches columns 26 to 30, so distances count from x = 310 m; rim of three cells.
  const double reach = 310 + 200 * slope / std::tan(11 * M_PI / 180) + 30;
  EXPECT_NEAR(window.east(), 500000 + reach, 10) << "to a cell";
  EXPECT_NEAR(window.west, 500000 + 260 - 30, 1e-6) << "level ground behind it is not below the line";
}

TEST_F(Slides, are_refused_with_their_place_and_all_at_once_beyond_the_model_too_and_without_a_polygon) {
  outlines({slide(300, 200, R"("name":"a","depth":2)"), slide(500, 200, R"("name":"a","depth":null)"),
            slide(700, 200, R"("name":"c","depth":-1)")});
  EXPECT_TRUE(holds(fault(by_depth + "margin_m = 50.0\n"),
                    {"feature 1: attribute depth is NULL", "feature 2: depth = -1", "name \"a\" is taken by"}));
  EXPECT_TRUE(holds(fault(with_set({{thickness_key, "t"}})), {"no attribute t (it has name, depth)"}));
  outlines({slide(300, 200, R"("name":"a","depth":2)"), slide(1180, 200, R"("name":"b","depth":2)")});
  EXPECT_TRUE(holds(fault(by_depth + "margin_m = 50.0\n"), {"feature 1 (b): its outline reaches beyond"}));
  outlines({});
  EXPECT_TRUE(holds(fault(by_depth), {"no feature"}));
  outlines({slide(300, 200, R"("name":"a","depth":2)")});
  std::string some = by_depth;
  some.insert(some.find(".geojson") + 8, "|subset=depth > 5");
  EXPECT_TRUE(holds(fault(some), {"no feature whose attributes meet depth > 5"}));
}

TEST_F(Slides, that_are_listed_choose_their_outline_and_set_values) {
  outlines({slide(300, 200, R"("name":"a","depth":2)"), slide(505, 405, R"("name":"b","depth":3)")});
  const EnsemblePlan plan = planned(
      "margin_m = 50.0\n"
      "[[slides.scenario]]\nname = \"soft\"\noutline = \"areas.geojson|subset=name = 'b'\"\n"
      "set = [\"preprocess.release[0].thickness_m = 2.5\", \"solve.base.friction_angle_deg = 14\"]\n"
      "[[slides.scenario]]\nname = \"stiff\"\noutline = \"areas.geojson|subset=name = 'b'\"\n"
      "set = [\"preprocess.release[0].thickness_m = 2.5\", \"solve.base.friction_angle_deg = 24\"]\n");
  EXPECT_EQ(plan.table.names, (std::vector<std::string>{"soft", "stiff"}));
  EXPECT_EQ(plan.table.find("solve.base.friction_angle_deg")->values, (std::vector<double>{14, 24}));
  EXPECT_EQ(plan.table.values_of(1, "solve."), (std::vector<std::string>{"solve.base.friction_angle_deg=24"}));
  EXPECT_EQ(plan.table.slides->windows[0].column, plan.table.slides->windows[1].column);
  EXPECT_TRUE(holds(fault("outlines = \"areas.geojson\"\n[[slides.scenario]]\nname = \"soft\"\n"),
                    {"[[slides.scenario]] soft has no outline"}));
}

}  // namespace
}  // namespace talus::preprocess
