// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Classes of intensity, cones of reach and numbers by building, each against what can be said by hand.
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/fields/fields.hpp"

#include "postprocess/score/score.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

/// A plain of 40 x 30 cells of 10 m on which the flow came to one row of cells, each a case of its own: h, v, p.
struct Case {
  double thickness, speed, pressure;  // [m], [m/s], [kPa]
};

RunMaps cases(const std::vector<Case>& list) {
  RunMaps maps;
  maps.grid = test::small_grid();
  maps.threshold = 0.1;
  maps.terrain.assign(maps.grid.count(), 0);
  maps.terrain[maps.grid.index(39, 0)] = nan;
  maps.deposit_thickness = maps.peak_thickness = maps.peak_speed = maps.peak_pressure_kPa =
      std::vector<double>(maps.grid.count(), 0.0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t cell = maps.grid.index(static_cast<int>(i), 5);
    maps.peak_thickness[cell] = list[i].thickness;
    maps.peak_speed[cell] = list[i].speed;
    maps.peak_pressure_kPa[cell] = list[i].pressure;
  }
  return maps;
}

std::vector<int> codes(const IntensityMap& map, const RunMaps& maps, int count) {
  std::vector<int> found;
  for (int i = 0; i < count; ++i) found.push_back(static_cast<int>(map.codes[maps.grid.index(i, 5)]));
  return found;
}

TEST(Intensity, of_debris_flows_asks_for_thickness_and_speed_and_own_limits_take_any_or_all) {
  const RunMaps maps = cases({{0.05, 9, 9}, {0.2, 0.2, 0}, {3, 0.9, 0}, {0.9, 20, 0}, {1, 1, 0}});
  const IntensityMap map = intensity_of(maps, {.guideline = Guideline::swiss_debris_flow});
  EXPECT_EQ(codes(map, maps, 5), (std::vector<int>{0, 2, 2, 2, 3})) << "what is thinner than the threshold is none";
  EXPECT_TRUE(std::isnan(map.codes[maps.grid.index(39, 0)])) << "outside the domain";
  EXPECT_EQ(map.classes[0].name, "medium");
  EXPECT_DOUBLE_EQ(map.classes[0].area, 300);
  EXPECT_DOUBLE_EQ(map.classes[1].area, 100);
  EXPECT_EQ(map.classes[1].words, "thickness \u2265 1 m and speed \u2265 1 m/s");
  const RunMaps some = cases({{1, 1, 1}, {5, 1, 1}, {5, 10, 1}, {5, 30, 1}, {20, 30, 1}});
  IntensityOptions own{.guideline = Guideline::own, .thickness = {2, 10}, .speed = {5, 20}};
  EXPECT_EQ(codes(intensity_of(some, own), some, 5), (std::vector<int>{0, 1, 1, 2, 2}));
  own.rule = Rule::all;
  EXPECT_EQ(codes(intensity_of(some, own), some, 5), (std::vector<int>{0, 0, 1, 1, 2}));
}

TEST(Intensity, of_other_guidelines_is_by_product_or_pressure) {
  const RunMaps floods = cases({{0.4, 1, 0}, {0.4, 1.3, 0}, {0.5, 0, 0}, {0.4, 6, 0}, {2, 0, 0}}),
                avalanches = cases({{1, 1, 2.9}, {1, 1, 3}, {1, 1, 29.9}, {1, 1, 30}}),
                on_buildings = cases({{1, 1, 14.9}, {1, 1, 15}, {1, 1, 30}, {1, 1, 35}, {1, 1, 100}});
  EXPECT_EQ(codes(intensity_of(floods, {.guideline = Guideline::swiss_flood}), floods, 5),
            (std::vector<int>{1, 2, 2, 3, 3}));
  EXPECT_EQ(codes(intensity_of(avalanches, {.guideline = Guideline::swiss_avalanche}), avalanches, 4),
            (std::vector<int>{1, 2, 2, 3}));
  const IntensityMap concrete = intensity_of(on_buildings, {.guideline = Guideline::debris_flow_concrete}),
                     other = intensity_of(on_buildings, {.guideline = Guideline::debris_flow_other});
  EXPECT_EQ(codes(concrete, on_buildings, 5), (std::vector<int>{1, 1, 1, 2, 3}));
  EXPECT_EQ(codes(other, on_buildings, 5), (std::vector<int>{1, 2, 3, 3, 3}));
  EXPECT_EQ(concrete.classes[2].name, "extensive damage");
  EXPECT_EQ(other.classes[2].words, "pressure \u2265 30 kPa");
  EXPECT_TRUE(test::holds(other.source, {"Kang & Kim (2014)"}));
}

TEST(Intensity, refuses_limits_that_make_no_classes) {
  const auto faults = [](IntensityOptions o) {
    std::vector<Fault> found;
    recipe::find_unmet(o, found);
    return found.size();
  };
  EXPECT_EQ(faults({.guideline = Guideline::own}), 1U) << "no limits";
  EXPECT_EQ(faults({.guideline = Guideline::swiss_flood, .speed = {1}}), 1U) << "whose then?";
  EXPECT_EQ(faults({.guideline = Guideline::own, .thickness = {1, 2}, .speed = {1}}), 1U) << "as many for each";
  EXPECT_EQ(faults({.guideline = Guideline::own, .thickness = {2, 1}}), 1U) << "rising";
  EXPECT_EQ(faults({.guideline = Guideline::own, .thickness = {1, 2}, .pressure = {3, 30}}), 0U);
}

/// A release of one cell, 100 m above a plain.
RunMaps tower() {
  RunMaps maps = cases({});
  maps.before = maps.terrain = std::vector<double>(maps.grid.count(), 0.0);
  maps.initial_thickness.assign(maps.grid.count(), 0.0);
  maps.before[maps.grid.index(5, 15)] = 100;
  maps.initial_thickness[maps.grid.index(5, 15)] = 1;
  return maps;
}

TEST(ReachCone, reaches_as_far_as_its_height_over_its_tangent) {
  RunMaps maps = tower();
  maps.peak_thickness = test::block(maps.grid, 5, 35, 15, 16, 2.0);  // 30 cells towards the east
  const auto cones = reach_cones(maps, 0, 1, {.angle = std::atan(0.4) * 180 / std::numbers::pi});
  ASSERT_EQ(cones.size(), 1U);
  for (int column = 6; column < 40; ++column) {
    const double head = cones[0].head[maps.grid.index(column, 15)], way = 10.0 * (column - 5);
    if (way < 250) {
      EXPECT_NEAR(head, 100 - 0.4 * way, 1e-9);
    }
    if (way > 250) {
      EXPECT_TRUE(std::isnan(head)) << column;
    }
  }
  EXPECT_NEAR(cones[0].covered, 26.0 / 30, 1.01 / 30) << "the cells within 250 m, the rim's one or not";
}

TEST(ReachCone, does_not_pass_a_ridge_above_its_line) {
  RunMaps maps = tower();
  for (int row = 0; row < maps.grid.rows; ++row) maps.before[maps.grid.index(15, row)] = 70;  // the line: 60 m at most
  const auto cones = reach_cones(maps, 0, 1, {.angle = std::atan(0.4) * 180 / std::numbers::pi});
  EXPECT_FALSE(std::isnan(cones[0].head[maps.grid.index(14, 15)]));
  EXPECT_TRUE(std::isnan(cones[0].head[maps.grid.index(15, 15)]));
  EXPECT_TRUE(std::isnan(cones[0].head[maps.grid.index(17, 15)])) << "behind it";
}

TEST(ReachCone, takes_the_angles_that_are_usual_for_the_volume) {
  const RunMaps maps = tower();
  EXPECT_TRUE(reach_cones(maps, 1e6, 1, {}).empty()) << "none was asked for";
  EXPECT_TRUE(reach_cones(maps, 5e3, 1, {.by_volume = true}).empty()) << "no regression holds for so little";
  const auto cones = reach_cones(maps, 1e6, 1, {.angle = 30, .by_volume = true});
  ASSERT_EQ(cones.size(), 3U);
  EXPECT_EQ(cones[0].name, "angle_deg");
  EXPECT_EQ(cones[1].name, "Scheidegger 1973");
  EXPECT_NEAR(cones[1].tangent, std::pow(10, 0.62419 - 0.15666 * 6), 1e-9);
  EXPECT_NEAR(cones[2].tangent, std::pow(10, -0.047 - 0.085 * 6), 1e-9);
}

/// The crown of a flat release reaches all around it, whatever its size: blocks stand for cells where they are many.
TEST(ReachCone, of_a_wide_flat_release_reaches_around_all_of_it) {
  RunMaps maps = tower();
  maps.grid.columns = maps.grid.rows = 120;
  maps.before.assign(maps.grid.count(), 0.0);
  maps.peak_thickness = maps.before;
  maps.initial_thickness = test::block(maps.grid, 40, 80, 40, 80, 1.0);
  for (std::size_t i = 0; i < maps.before.size(); ++i) maps.before[i] = maps.initial_thickness[i] > 0 ? 50 : 0;
  const auto cones = reach_cones(maps, 0, 1, {.angle = 45});
  for (int column = 35; column < 85; ++column)
    EXPECT_FALSE(std::isnan(cones[0].head[maps.grid.index(column, 60)])) << column;
  EXPECT_TRUE(std::isnan(cones[0].head[maps.grid.index(33, 60)]));
}

MapPolygon house(double west, double south, double width, double depth, const std::string& name = "") {
  return {{{{west, south}, {west + width, south}, {west + width, south + depth}, {west, south + depth}}}, {}, name};
}

/// A house of 12 x 5 m in a uniform flow: F = p h w with the diagonal of 13 m as its width.
TEST(Buildings, bear_pressure_times_thickness_times_width) {
  auto run = test::small_run();
  const MapGrid& grid = run.maps.grid;
  run.maps.peak_thickness = test::block(grid, 10, 30, 5, 25, 2.0);
  run.maps.peak_speed = test::block(grid, 10, 30, 5, 25, 10.0);
  run.maps.peak_pressure_kPa = test::block(grid, 10, 30, 5, 25, 200.0);
  run.maps.arrival_time.assign(grid.count(), nan);
  run.maps.arrival_time[grid.index(20, 15)] = 7.5;
  MapPolygon tall = house(grid.x(20) - 6, grid.y(15) - 2.5, 12, 5, "school"), low = tall,
             aside = house(grid.x(2), grid.y(2), 12, 5);
  tall.numbers = {{"height", 8}};
  low.numbers = {{"height", 1.5}};
  low.name = "kiosk";
  const auto found = buildings_of(run, {tall, low, aside}, {}, {});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0].force, 200e3 * 2 * 13, 1e-3);
  EXPECT_NEAR(found[1].force, 200e3 * 1.5 * 13, 1e-3) << "no higher than it is";
  EXPECT_EQ(found[0].source, ForceSource::pressure);
  EXPECT_EQ(found[0].thickness.largest, 2);
  EXPECT_EQ(found[0].thickness.p99, 2);
  EXPECT_EQ(found[0].speed.largest, 10);
  EXPECT_EQ(found[0].arrival, 7.5);
  EXPECT_EQ(found[2].name, "building 3");
  EXPECT_EQ(found[2].force, 0);
  EXPECT_TRUE(std::isnan(found[2].arrival));
  EXPECT_NEAR(buildings_of(run, {tall}, {}, {.pressure_coefficient = 1.5})[0].force, 1.5 * 200e3 * 2 * 13, 1e-3);
}

TEST(Buildings, that_are_obstacles_have_the_force_that_contact_gave_them) {
  auto run = test::small_run();
  const auto column = [](const char* name, std::vector<double> values) {
    return HistoryColumn{.name = name, .unit = "", .quantity = "", .place = "", .values = std::move(values)};
  };
  run.history.columns = {column("time_s", {0, 1, 3}), column("obstacle_wall_impulse_x_N_s", {0, 30, 30}),
                         column("obstacle_wall_impulse_y_N_s", {0, 40, 240}),
                         column("obstacle_wall_impulse_z_N_s", {0, 0, 0})};
  const MapPolygon wall = house(600200, 5100150, 12, 5, "wall"), part = house(600230, 5100150, 12, 5, "wall");
  const auto found = buildings_of(run, {house(600100, 5100150, 12, 5, "school")}, {wall, part}, {});
  ASSERT_EQ(found.size(), 2U) << "polygons of one name are one obstacle";
  EXPECT_EQ(found[1].name, "wall");
  EXPECT_EQ(found[1].source, ForceSource::obstacle);
  EXPECT_DOUBLE_EQ(found[1].force, 100);
  EXPECT_NEAR(found[1].width, std::hypot(42, 5), 1e-9);
  const auto same = buildings_of(run, {house(600200, 5100150, 3, 4, "wall")}, {wall}, {});
  ASSERT_EQ(same.size(), 1U);
  EXPECT_DOUBLE_EQ(same[0].force, 100);
  EXPECT_DOUBLE_EQ(same[0].width, 5) << "the building's own footprint";
}

TEST(Buildings, table_quotes_names_and_leaves_out_what_never_came) {
  Building b;
  b.name = "The \"old\" mill, east";
  EXPECT_TRUE(test::holds(buildings_table({b}), {"\n\"The \"\"old\"\" mill, east\",,0,0,"}));
  b.name = "=cmd|'/C calc'!A0";
  EXPECT_TRUE(test::holds(buildings_table({b}), {"\n'=cmd|'/C calc'!A0,"})) << "no formula of a spreadsheet";
}

TEST(CsvField, holds_no_formula_and_leaves_numbers) {
  for (const char* formula : {"=1+1", "+A1", "-A1", "@SUM(A1)", "\tx"})
    EXPECT_EQ(csv_field(formula).front(), '\'') << formula;
  for (const char* plain : {"-5.5", "+3", "mill", "a=b", ""}) EXPECT_EQ(csv_field(plain), plain);
}

TEST(ScoreOfHazard, has_a_percentile_beside_every_largest_value) {
  const auto run = test::small_run();
  const Score score = make_score(run, {}, std::nullopt, thalweg_of(run, {}));
  int found = 0;
  for (const auto& section : score.sections)
    for (const auto& entry : section.entries) {
      const bool of_cells = entry.key.find("thickness") != entry.key.npos || entry.key.find("_peak_") != entry.key.npos;
      if (!entry.key.starts_with("max_") || entry.key.ends_with("slope_normal_m") || !of_cells) continue;
      const auto p99 = score.number("p99_" + entry.key.substr(4));
      ASSERT_TRUE(p99) << entry.key;
      EXPECT_LE(*p99, std::get<double>(entry.value)) << entry.key;
      ++found;
    }
  EXPECT_EQ(found, 5);
}

}  // namespace
}  // namespace talus::postprocess
