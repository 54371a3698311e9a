// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is only implausible is refused by name, and goes on where the recipe insists; growth and factors of sources.
#include <algorithm>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "common/domain/domain.hpp"
#include "common/gis/crs.hpp"
#include "data_samples/terrains.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/terrain/plausible_ground.hpp"
#include "preprocess/terrain/triangulation.hpp"
#include "tests/common/findings.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::holds;
using test::raster_of;
using test::Scene;
using test::Scratch;

/// A rectangle of 60 x 75 m.
std::filesystem::path rectangle(const Scene& scene) {
  const double x = scene.grid.west + 123, y = scene.grid.south + 101;
  return test::write_polygon(scene.scratch, "outline.csv", test::rectangle(x, y, x + 60, y + 75));
}

/// Of that rectangle grown by a distance, corners round to a thousandth of it.
double area_grown(double by) {
  return by >= 0 ? 60 * 75 + 2 * 135 * by + std::numbers::pi * by * by : (60 + 2 * by) * (75 + 2 * by);
}

using grow = test::WithScene;

TEST_F(grow, a_source_by_its_outline) {
  for (const double by : {0.0, 12.0, -12.0}) {
    Scene scene;
    scene.options.source.polygon = rectangle(scene);
    Raster lowered = scene.before;
    for (double& z : lowered.values) z -= 4;  // lowered everywhere: the outline alone says what counts
    scene.rewrite_after(lowered);
    scene.options.source.grow = by;
    EXPECT_NEAR(scene.prepare().total.volume / (4 * area_grown(by)), 1, 1e-3) << by;
    scene.options.sliding_surface = test::write(scene.scratch, "surface.tif", lowered);
    scene.options.after_dem.clear();
    EXPECT_NEAR(scene.prepare().total.volume / (4 * area_grown(by)), 1, 1e-3) << by;
  }
}

TEST_F(grow, a_computed_sliding_surface_reaches_further_under_a_wider_outline) {
  options.after_dem.clear();
  options.source.polygon = rectangle(*this);
  options.source.sliding_surface.depth = 10;
  const double alone = prepare().total.projected_area;
  options.source.grow = 15;
  const Prepared wider = prepare();
  EXPECT_GT(wider.total.projected_area, 1.4 * alone);
  EXPECT_NEAR(wider.sliding_surface->depth, 10, 1e-6);
}

TEST_F(grow, a_release_by_polygons) {
  ReleaseOptions& release = as_release();
  release.polygons = rectangle(*this);
  release.thickness = 3;
  release.grow = -10;
  EXPECT_NEAR(prepare().total.volume / (3 * area_grown(-10)), 1, 1e-9);
  release.grow = -40;
  EXPECT_TRUE(holds(data_fault(), {"nothing is left of it with grow_m = -40"}));
}

TEST_F(grow, what_has_no_outline_is_refused) {
  options.source.grow = 5;
  EXPECT_TRUE(holds(test::faults_of(options), {"source.grow_m is given without source.polygon"}));
  options.source.grow = 0;
  ReleaseOptions& release = as_release();
  release.thickness_raster = test::write(scratch, "bowl.tif", bowl);
  release.grow = 5;
  EXPECT_TRUE(holds(test::faults_of(options), {"release 1: grow_m is given without polygons"}));
}

TEST(survey_memory, gives_what_a_comparison_gives_and_tells_other_surveys) {
  const test::Seeded random;
  Scene scene(random.number);
  SurveyMemory memory;
  read_scene(scene.options, &memory);
  for (const double threshold : {0.5, 3.0}) {
    scene.options.source.threshold = threshold;
    const SceneRasters kept = read_scene(scene.options, &memory), fresh = read_scene(scene.options);
    EXPECT_EQ(kept.bed.values, fresh.bed.values);
    EXPECT_EQ(kept.releases[0].thickness.values, fresh.releases[0].thickness.values);
    EXPECT_EQ(kept.slide->sigma.values, fresh.slide->sigma.values);
  }
  scene.options.difference.sigma = 0.5;  // another error: the kept survey is not taken
  EXPECT_EQ(read_scene(scene.options, &memory).survey->errors.typical(), 0.5);
}

/// Volume of the points of each cell, and its moment above the bed: [rows * columns] each, [m3] and [m4].
struct Columns {
  std::vector<double> volume, moment;
  explicit Columns(const Domain& d) : volume(d.grid.count(), 0.0), moment(d.grid.count(), 0.0) {
    for (std::size_t p = 0; p < d.points.size(); ++p) {
      const auto cell = d.grid.index(static_cast<int>((d.points.x[p] - d.grid.west) / d.grid.cell),
                                     static_cast<int>((d.points.y[p] - d.grid.south) / d.grid.cell));
      volume[cell] += d.points.volume[p];
      moment[cell] += d.points.volume[p] * d.points.height[p];
    }
  }
};

/// Rasters to rounding of elevations around 1,000 m; columns of points to that of sums over some ten of them.
void expect_same_mass(const Domain& a, const Domain& b) {
  EXPECT_EQ(a.terrain.values, b.terrain.values);
  test::expect_near(a.before.values, b.before.values, 1e-9);
  test::expect_near(a.release_thickness.values, b.release_thickness.values, 1e-9);
  const Columns of_a(a), of_b(b);
  test::expect_near(of_a.volume, of_b.volume, 1e-8);
  test::expect_near(of_a.moment, of_b.moment, 1e-6);
}

void expect_scaled_is_made(Scene& scene, double factor) {
  Domain scaled = scene.prepare().domain;
  scale_release(scaled, factor);
  scene.options.thickness_factor = factor;
  expect_same_mass(scaled, scene.prepare().domain);
}

using thickness_factor = test::WithScene;

TEST_F(thickness_factor, of_a_source_between_two_models_is_that_of_its_domain) {
  const test::Seeded random;
  for (const double factor : {0.4, 1.7}) {
    Scene scene(random.number);
    expect_scaled_is_made(scene, factor);
  }
}

TEST_F(thickness_factor, of_releases_over_erodible_ground_leaves_the_ground_alone) {
  const test::Seeded random;
  Scene scene(random.number);
  scene.as_release().thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  scene.options.release.emplace_back(scene.options.release[0]);  // a second one lies on the first
  ErodibleOptions& layer = scene.options.erodible.emplace_back();
  const double x = scene.grid.west, y = scene.grid.south;
  layer.polygons = test::write_polygon(scene.scratch, "ground.csv", test::rectangle(x + 83, y + 101, x + 180, y + 201));
  layer.thickness = 2.5;
  expect_scaled_is_made(scene, 1.3);
  Domain base = scene.prepare().domain, scaled = base;
  scale_release(scaled, 2);
  for (std::size_t p = 0; p < base.points.size(); ++p) {
    if (base.points.release[p] >= base.erodible) continue;
    EXPECT_EQ(scaled.points.height[p], base.points.height[p]);
    EXPECT_EQ(scaled.points.volume[p], base.points.volume[p]);
  }
}

TEST_F(thickness_factor, of_layers_that_share_ground_is_said) {
  ErodibleOptions layer;
  const double x = grid.west, y = grid.south;
  layer.polygons = test::write_polygon(scratch, "ground.csv", test::rectangle(x + 83, y + 101, x + 180, y + 201));
  layer.thickness = 2.5;
  options.erodible = {layer, layer};
  const auto found = prepare().domain.findings;
  const auto said = std::ranges::find(found, "releases-overlap", &Finding::name);
  ASSERT_NE(said, found.end());
  EXPECT_TRUE(said->message.starts_with("erodible-1 and erodible-2 share")) << said->message;
}

TEST_F(thickness_factor, stretches_every_point_where_as_many_are_seeded) {
  options.grid.layer_height = 2;
  Domain scaled = prepare().domain;
  scale_release(scaled, 1.5);
  options.thickness_factor = 1.5;
  options.grid.layer_height = 3;
  const Domain made = prepare().domain;
  test::expect_near(scaled.points.height, made.points.height, 1e-9);
  test::expect_near(scaled.points.volume, made.points.volume, 1e-9);
  EXPECT_EQ(scaled.points.x, made.points.x);
}

TEST_F(thickness_factor, of_a_box_scales_its_height_from_the_ground) {
  Options o;
  o.grid.spacing = 1;
  o.laboratory.columns = o.laboratory.rows = 12;
  o.box.push_back({"", 3.5, 6.5, 4, 6, 0, 2.5});
  options = o;
  expect_scaled_is_made(*this, 0.8);
  EXPECT_NEAR(prepare().total.volume, 3 * 2 * 2.5 * 0.8, 1e-12);
  options.box[0].bottom = 1;
  EXPECT_TRUE(holds(recipe_fault(), {"thickness_factor = 0.8 with a box whose bottom lies above the ground"}));
}

TEST_F(thickness_factor, that_is_not_positive_is_refused) {
  Domain domain;
  for (const double factor : {0.0, -1.0, std::nan(""), double{INFINITY}})
    EXPECT_THROW(scale_release(domain, factor), std::logic_error);
}

/// The sample valley, its heights divided by `metres`, on a map in `crs`.
struct Valley {
  Scratch scratch;
  Options options;
  explicit Valley(double metres = 1, const std::string& crs = "") {
    samples::Sample sample = samples::valley(10);
    for (auto& [name, raster] : sample.rasters) {
      for (double& z : raster.values) z /= metres;
      if (!crs.empty()) {
        raster.grid.crs_wkt = crs_by_name(crs);
        raster.grid.west = -8000000;
        raster.grid.south = 5000000;
      }
    }
    options = test::two_models(test::write(scratch, "before.tif", sample.rasters.at(0).second),
                               test::write(scratch, "after.tif", sample.rasters.at(1).second));
  }
  std::string fault() const {
    return test::fault_of<DataError>([&] { prepare(options, Points::counted); });
  }
};

TEST(plausible, surveys_in_the_wrong_order_are_refused_and_accepted_by_name) {
  Valley valley;
  EXPECT_EQ(valley.fault(), "");
  std::swap(valley.options.before_dem, valley.options.after_dem);
  EXPECT_TRUE(holds(valley.fault(), {"higher than what fell", "swap before_dem", "built up",
                                     "accept = [\"swapped-surveys\"] in [preprocess]"}));
  valley.options.accept = {"false-lengths"};
  EXPECT_NE(valley.fault(), "") << "another name is no acceptance";
  valley.options.accept = {"swapped-surveys", "doubtful-source"};
  const Prepared prepared = prepare(valley.options, Points::counted);
  ASSERT_TRUE(is_accepted(prepared.domain.findings, "swapped-surveys"));
  EXPECT_TRUE(holds(accepted_line(prepared.domain.findings), {"before.tif"}));
}

TEST(plausible, all_that_is_implausible_is_said_at_once_and_nothing_that_the_recipe_does_already) {
  Valley valley(0.3048, "EPSG:3857");
  std::swap(valley.options.before_dem, valley.options.after_dem);
  const std::string fault = valley.fault();
  for (const std::string name : {"swapped-surveys", "false-lengths", "steep-ground"})
    EXPECT_TRUE(holds(fault, {"accept = [\"" + name + "\"] in [preprocess]"})) << name << ": " << fault;
  std::swap(valley.options.before_dem, valley.options.after_dem);
  valley.options.working_crs = "EPSG:3857";
  valley.options.vertical_unit = VerticalUnit::metre;
  EXPECT_TRUE(holds(valley.fault(), {"Name another working_crs", "The recipe says metres"}));
}

TEST(plausible, steep_ground_names_every_cause_and_how_to_tell_them_apart) {
  const MapGrid grid = test::grid_of(60, 40, 10);
  const auto refusal = [&](const std::function<double(double)>& height) {
    const Raster surface = test::raster_of(grid, [&](double x, double) { return height(x - grid.west); });
    return test::fault_of<DataError>([&] { judge_heights(surface, "dem.tif", VerticalUnit::declared); });
  };
  const auto rock = [](double x) { return 900 + 0.4 * std::min(x, 440.0) + 1.45 * std::clamp(x - 440, 0.0, 120.0); };
  const auto feet = [](double x) { return (900 + 0.45 * x) / 0.3048; };
  const auto kilometres = [](double x) { return 900 + 0.03 * x * 1000; };
  const auto high = [](double x) { return 29032 + 0.1 * x; };
  for (const auto& height : std::vector<std::function<double(double)>>{rock, feet, kilometres, high})
    EXPECT_TRUE(holds(refusal(height), {"dem.tif", "Rock walls", "in feet", "another unit than heights", "known summit",
                                        "two known places", "vertical_unit", "gdal_edit.py -a_srs", "steep-ground"}));
  for (const double slope : {0.3, 0.7, 1.0, 1.15})
    EXPECT_EQ(refusal([&](double x) { return 4000 + slope * x; }), "") << slope;
}

/// The mean of 3 x 3 cells.
Raster smoothed(const Raster& raster) {
  Raster mean = raster;
  each_cell(raster.grid, [&](int column, int row) {
    double sum = 0;
    int count = 0;
    each_near(raster.grid, {column, row}, 1, [&](int c, int r) { sum += raster.at(c, r), ++count; });
    mean.at(column, row) = sum / count;
  });
  return mean;
}

/// A slope with a hole of `value` in it, 21 cells wide, smoothed three times as resampling mixes it.
Raster mixed_hole(double value) {
  const MapGrid grid = grid_of(60, 60, 10);
  return smoothed(smoothed(smoothed(raster_of(grid, [&](double x, double y) {
    const bool hole = std::abs(x - grid.west - 300) < 105 && std::abs(y - grid.south - 300) < 105;
    return hole ? value : 700 + 0.4 * (x - grid.west);
  }))));
}

TEST(plausible, values_for_missing_cells_that_were_mixed_with_heights_are_found) {
  for (const double value : {0.0, -99.0, 3000.0}) {
    const std::string fault = test::fault_of<DataError>([&] { judge_fill_values(mixed_hole(value), "dem.tif"); });
    EXPECT_TRUE(holds(fault, {"dem.tif: ", fmt::format("cells hold {:g} exactly", value), "mixed with heights",
                              "gdalwarp -srcnodata", "fill-value"}));
  }
  Raster voids = mixed_hole(-9999);
  for (double& z : voids.values)
    if (z == -9999) z = nan;
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { judge_fill_values(voids, "dem.tif"); }),
                    {"beside cells without elevation", "mixed-voids"}));
}

TEST(plausible, lakes_quarries_and_voids_of_real_ground_are_no_missing_cells) {
  const MapGrid grid = grid_of(60, 60, 10);
  const auto is_fine = [&](const std::function<double(double, double)>& height) {
    const Raster ground = raster_of(grid, [&](double x, double y) { return height(x - grid.west, y - grid.south); });
    return test::fault_of<DataError>([&] { judge_fill_values(ground, "dem.tif"); });
  };
  const auto slope = [](double x) { return 700 + 0.4 * x; };
  EXPECT_EQ(is_fine([&](double x, double y) {  // a lake behind walls of 40 to 120 m that runs out to the west
              const bool wide =
                  std::abs(x - 250) < 100 && std::abs(y - 300)<100, out = x> 50 && x < 250 && std::abs(y - 300) < 20;
              return wide || out ? 720.0 : slope(x);
            }),
            "");
  EXPECT_EQ(is_fine([&](double x, double y) {  // a hole in a wall
              return std::abs(x - 300) < 60 && std::abs(y - 300) < 30 ? nan : slope(x) + (x > 300 ? 120 : 0);
            }),
            "");
}

TEST(plausible, releases_thicker_than_they_are_wide_are_said_or_refused) {
  const MapGrid grid = grid_of(40, 40, 10);
  const auto judged = [&](double thickness) {
    const Raster release = raster_of(grid, [&](double x, double y) {
      return std::hypot(x - grid.west - 200, y - grid.south - 200) < 60 ? thickness : 0.0;
    });
    return [release] { judge_thickness(release, "release a"); };
  };
  EXPECT_TRUE(test::findings_of(judged(20)).empty());
  EXPECT_TRUE(holds(test::messages_of(judged(60)).at(0), {"release a: 60 m thick", "centimetres", "place and datum"}));
  EXPECT_TRUE(
      holds(test::fault_of<DataError>([&] { test::findings_of(judged(200)); }), {"200 m thick", "thick-release"}));
}

TEST(plausible, a_sliding_surface_that_ends_below_the_ground_is_said) {
  const MapGrid grid = grid_of(40, 40, 10);
  const auto said = [&](double deepest, double below) {
    const Raster thickness = raster_of(grid, [&](double x, double y) {
      const double r = std::hypot(x - grid.west - 200, y - grid.south - 200) / 100;
      return r < 1 ? deepest * (1 - r * r) + below : 0;
    });
    return test::findings_of([&] { warn_of_step_at_rim(thickness, "surface.tif"); });
  };
  EXPECT_TRUE(said(30, 0).empty());
  EXPECT_TRUE(said(30, 5).empty());
  EXPECT_EQ(said(10, 20).at(0).name, "step-at-rim");
}

TEST(plausible, plains_and_depths_are_said) {
  const MapGrid grid = grid_of(60, 40, 10);
  const auto said = [&](const std::function<double(double)>& height) {
    const Raster surface = raster_of(grid, [&](double x, double) { return height(x - grid.west); });
    std::string names;
    for (const Finding& f : test::findings_of([&] { judge_heights(surface, "dem.tif", VerticalUnit::declared); }))
      names += f.name + " ";
    return names;
  };
  EXPECT_EQ(said([](double) { return 0.0; }), "flat-ground ");
  EXPECT_EQ(said([](double x) { return (900 + 0.5 * x) / 1000; }), "flat-ground ");
  EXPECT_EQ(said([](double x) { return -900 - 0.5 * x; }), "below-all-land ");
  EXPECT_EQ(said([](double x) { return -300 + 0.1 * x; }), "");
}

TEST(plausible, points_that_leave_gaps_or_contradict_one_another_are_said) {
  const auto points = [](bool gap, double doubled) {
    ScatteredPoints p;
    for (int i = 0; i < 60; ++i)
      for (int j = 0; j < 60; ++j) {
        if (gap && i > 20 && i < 40 && j > 20 && j < 40) continue;
        p.x.push_back(5.0 * i + 0.3 * (j % 3));
        p.y.push_back(5.0 * j);
        p.z.push_back(i);
      }
    if (doubled == 0) return p;
    p.x.push_back(p.x[100]);
    p.y.push_back(p.y[100]);
    p.z.push_back(p.z[100] + doubled);
    return p;
  };
  const auto said = [&](bool gap, double doubled) {
    const ScatteredPoints p = points(gap, doubled);
    std::string names;
    for (const Finding& f : test::findings_of([&] { warn_of_points(p, "points.xyz"); })) names += f.name + " ";
    return names;
  };
  EXPECT_EQ(said(false, 0), "");
  EXPECT_EQ(said(false, 0.05), "");
  EXPECT_EQ(said(true, 0), "gaps-between-points ");
  EXPECT_EQ(said(false, 3), "points-at-one-place ");
}

/// A scar whose deposit the river took: swapped, mass comes from nowhere.
TEST(plausible, more_rise_than_any_fall_gives_is_refused) {
  Scratch scratch;
  const MapGrid grid = grid_of(60, 60, 10);
  const auto ground = [&](double, double y) { return 0.3 * (y - grid.south); };
  Options options;
  options.after_dem = test::write(scratch, "whole.tif", raster_of(grid, ground));
  options.before_dem =
      test::write(scratch, "scar.tif", raster_of(grid, [&](double x, double y) {
                    const double r = std::hypot(x - grid.west - 300, y - grid.south - 400);
                    const double s = std::hypot(x - grid.west - 300, y - grid.south - 500);
                    return ground(x, y) - 12 * std::max(0.0, 1 - r / 80) + 3 * std::max(0.0, 1 - s / 30);
                  }));
  EXPECT_TRUE(
      holds(test::fault_of<DataError>([&] { prepare(options, Points::counted); }), {"times as much rose as fell"}));
}

TEST(plausible, a_map_in_web_mercator_is_refused_and_reprojected_it_is_not) {
  Valley valley(1, "EPSG:3857");
  EXPECT_TRUE(holds(valley.fault(), {"accept = [\"false-lengths\"]", "working_crs = \"utm\""}));
  valley.options.working_crs = "utm";
  EXPECT_EQ(valley.fault(), "") << "what it says helps";
}

TEST(plausible, heights_in_feet_that_no_file_declares_are_refused_without_a_second_survey_too) {
  Valley valley(0.3048);
  EXPECT_TRUE(holds(valley.fault(), {"accept = [\"steep-ground\"]", "vertical_unit = \"foot\""}));
  valley.options.vertical_unit = VerticalUnit::foot;
  EXPECT_EQ(valley.fault(), "") << "what it says helps";
  valley.options.vertical_unit = VerticalUnit::metre;
  valley.options.accept = {"steep-ground"};
  EXPECT_EQ(valley.fault(), "");
  valley.options.accept.clear();
  valley.options.vertical_unit = {};
  valley.options.sliding_surface = valley.options.after_dem;
  valley.options.after_dem.clear();
  EXPECT_TRUE(holds(valley.fault(), {"accept = [\"steep-ground\"]"}));
}

TEST(plausible, a_release_of_few_cells_is_warned_of_with_numbers_that_help) {
  const auto release = [](double cell) {
    const int count = static_cast<int>(400 / cell);
    return raster_of(grid_of(count, count, cell), [](double x, double y) {
      return std::abs(x - 500200) < 30 && std::abs(y - 5100200) < 30 ? 6.0 : 0.0;
    });
  };
  const auto said = [](const Raster& thickness, double layers, std::size_t points, const GridOptions& grid) {
    const auto found = test::messages_of([&] { warn_of_coarseness(thickness, layers, points, grid); });
    return found.empty() ? "" : found.at(0);
  };
  EXPECT_TRUE(holds(said(release(10), 3, 288, {}), {"6 cells of 10 m across", "put spacing_m = 7.5 into"}));
  EXPECT_EQ(said(release(5), 3, 2304, {}), "") << "finer than it asks for";
  GridOptions given;
  given.layer_height = 5;
  const std::string thin = said(release(5), 5, 1000, given);
  EXPECT_TRUE(holds(thin, {"put layer_height_m = 3 into"})) << "1.2 layers over the thickness: " << thin;
  EXPECT_EQ(said(raster_of(grid_of(9, 9, 10), [](double, double) { return 0.0; }), 3, 0, {}), "");
}

TEST(plausible, accept_is_read_as_written_and_knows_its_names) {
  Options options = test::two_models("/before.tif", "/after.tif");
  options.accept = {"swapped-surveys", "steep-ground"};
  test::expect_read_as_written(options);
  const Scratch scratch;
  const recipe::Recipe recipe(scratch.write(
      "recipe.toml", "[preprocess]\nbefore_dem = \"b.tif\"\nafter_dem = \"a.tif\"\naccept = [\"swaped-surveys\"]\n"));
  EXPECT_TRUE(holds(test::fault_of<RecipeError>([&] { recipe.read<Options>("preprocess"); }),
                    {"Did you mean \"swapped-surveys\"?"}));
}

}  // namespace
}  // namespace talus::preprocess
