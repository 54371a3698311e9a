// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is only implausible is refused by name, and goes on where the recipe insists.
#include "common/gis/crs.hpp"
#include "data_samples/terrains.hpp"
#include "preprocess/particles/coarseness.hpp"
#include "tests/common/findings.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;
using test::Scratch;

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
    options.before_dem = test::write(scratch, "before.tif", sample.rasters.at(0).second);
    options.after_dem = test::write(scratch, "after.tif", sample.rasters.at(1).second);
  }
  std::string fault() const {
    return test::fault_of<DataError>([&] { prepare(options, Points::counted); });
  }
};

TEST(plausible, surveys_in_the_wrong_order_are_refused_and_accepted_by_name) {
  Valley valley;
  EXPECT_EQ(valley.fault(), "");
  std::swap(valley.options.before_dem, valley.options.after_dem);
  EXPECT_NE(valley.fault().find("higher than what fell"), std::string::npos) << valley.fault();
  EXPECT_NE(valley.fault().find("accept = [\"swapped-surveys\"] in [preprocess]"), std::string::npos);
  valley.options.accept = {"false-lengths"};
  EXPECT_NE(valley.fault(), "") << "another name is no acceptance";
  valley.options.accept = {"swapped-surveys"};
  const Prepared prepared = prepare(valley.options, Points::counted);
  ASSERT_TRUE(is_accepted(prepared.domain.findings, "swapped-surveys"));
  EXPECT_NE(accepted_line(prepared.domain.findings).find("before.tif"), std::string::npos);
}

TEST(plausible, all_that_is_implausible_is_said_at_once) {
  Valley valley(0.3048, "EPSG:3857");
  std::swap(valley.options.before_dem, valley.options.after_dem);
  const std::string fault = valley.fault();
  for (const std::string name : {"swapped-surveys", "false-lengths", "steep-ground"})
    EXPECT_NE(fault.find("accept = [\"" + name + "\"] in [preprocess]"), std::string::npos) << name << ": " << fault;
}

TEST(plausible, nothing_is_advised_that_the_recipe_does_already) {
  Valley valley(0.3048, "EPSG:3857");
  valley.options.working_crs = "EPSG:3857";
  valley.options.vertical_unit = VerticalUnit::metre;
  const std::string fault = valley.fault();
  EXPECT_NE(fault.find("Name another working_crs"), std::string::npos) << fault;
  EXPECT_NE(fault.find("The recipe says metres"), std::string::npos) << fault;
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
  const std::string fault = test::fault_of<DataError>([&] { prepare(options, Points::counted); });
  EXPECT_NE(fault.find("times as much rose as fell"), std::string::npos) << fault;
}

TEST(plausible, a_map_in_web_mercator_is_refused_and_reprojected_it_is_not) {
  Valley valley(1, "EPSG:3857");
  EXPECT_NE(valley.fault().find("accept = [\"false-lengths\"]"), std::string::npos) << valley.fault();
  EXPECT_NE(valley.fault().find("working_crs = \"utm\""), std::string::npos) << valley.fault();
  valley.options.working_crs = "utm";
  EXPECT_EQ(valley.fault(), "") << "what it says helps";
}

TEST(plausible, heights_in_feet_that_no_file_declares_are_refused) {
  Valley valley(0.3048);
  EXPECT_NE(valley.fault().find("accept = [\"steep-ground\"]"), std::string::npos) << valley.fault();
  EXPECT_NE(valley.fault().find("vertical_unit = \"foot\""), std::string::npos) << valley.fault();
  valley.options.vertical_unit = VerticalUnit::foot;
  EXPECT_EQ(valley.fault(), "") << "what it says helps";
  valley.options.vertical_unit = VerticalUnit::metre;
  valley.options.accept = {"steep-ground"};
  EXPECT_EQ(valley.fault(), "");
}

TEST(plausible, heights_are_looked_at_without_a_second_survey_too) {
  Valley valley(0.3048);
  valley.options.sliding_surface = valley.options.after_dem;
  valley.options.after_dem.clear();
  EXPECT_NE(valley.fault().find("accept = [\"steep-ground\"]"), std::string::npos) << valley.fault();
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
  const std::string coarse = said(release(10), 3, 288, {});
  EXPECT_NE(coarse.find("6 cells of 10 m across"), std::string::npos) << coarse;
  EXPECT_NE(coarse.find("put spacing_m = 7.5 into"), std::string::npos) << coarse;
  EXPECT_EQ(said(release(5), 3, 2304, {}), "") << "finer than it asks for";
  GridOptions given;
  given.layer_height = 5;
  const std::string thin = said(release(5), 5, 1000, given);
  EXPECT_NE(thin.find("put layer_height_m = 3 into"), std::string::npos) << "1.2 layers over the thickness: " << thin;
  EXPECT_EQ(said(raster_of(grid_of(9, 9, 10), [](double, double) { return 0.0; }), 3, 0, {}), "");
}

TEST(plausible, accept_is_read_as_written_and_knows_its_names) {
  Options options;
  options.before_dem = "/before.tif";
  options.after_dem = "/after.tif";
  options.accept = {"swapped-surveys", "steep-ground"};
  test::expect_read_as_written(options);
  const Scratch scratch;
  const recipe::Recipe recipe(scratch.write(
      "recipe.toml", "[preprocess]\nbefore_dem = \"b.tif\"\nafter_dem = \"a.tif\"\naccept = [\"swaped-surveys\"]\n"));
  const std::string fault = test::fault_of<RecipeError>([&] { recipe.read<Options>("preprocess"); });
  EXPECT_NE(fault.find("Did you mean \"swapped-surveys\"?"), std::string::npos) << fault;
}

}  // namespace
}  // namespace talus::preprocess
