// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/laboratory/laboratory.hpp"

#include <map>

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::faults_of;

Options bench() {
  Options o;
  o.grid.spacing = 1;
  o.grid.points_per_cell = {2, 2, 2};
  o.laboratory.columns = 12;
  o.laboratory.rows = 10;
  o.box.push_back({"", 3.5, 6.5, 4, 6, 0, 2.5});
  return o;
}

Prepared prepared(const Options& o) { return prepare(o, Points::seeded); }

double volume_of(const SeedPoints& points, int release) {
  Sum sum;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.release[p] == release) sum.add(points.volume[p]);
  return sum.value();
}

TEST(laboratory, fills_a_box_with_a_lattice_from_its_own_corner) {
  Options o = bench();
  o.box[0] = {"", 3.2, 5.7, 4.1, 6.1, 1.5, 4};
  const SeedPoints points = prepared(o).domain.points;
  ASSERT_EQ(points.size(), 5u * 4 * 5);
  std::size_t p = 0;
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 5; ++i, ++p) {
        ASSERT_NEAR(points.x[p], 3.45 + 0.5 * i, 1e-12);
        ASSERT_NEAR(points.y[p], 4.35 + 0.5 * j, 1e-12);
        ASSERT_NEAR(points.height[p], 1.75 + 0.5 * k, 1e-12);
        ASSERT_NEAR(points.volume[p], 0.125, 1e-14);
      }
    }
  }
}

TEST(laboratory, keeps_the_volume_of_every_box_whatever_its_place_and_the_spacing) {
  test::Seeded random;
  std::uniform_int_distribution<int> few(1, 5);
  std::uniform_real_distribution<double> part(0, 1);
  for (int trial = 0; trial < 30; ++trial) {
    Options o = bench();
    o.laboratory.columns = o.laboratory.rows = 40;
    o.laboratory.west = 500000 * part(random);
    o.laboratory.south = 5100000 * part(random);
    o.grid.spacing = 0.01 + 3 * part(random);
    o.grid.layer_height = 0.01 + 3 * part(random);
    o.grid.points_per_cell = {few(random), few(random), few(random)};
    o.box.clear();
    const auto& n = o.grid.points_per_cell;
    double low = 0;
    for (int b = 0; b < 3; ++b) {  // on one another
      const double x = o.laboratory.west + (2 + 20 * part(random)) * o.grid.spacing;
      const double y = o.laboratory.south + (2 + 20 * part(random)) * o.grid.spacing;
      const double height = few(random) * o.grid.layer_height / n[2];
      o.box.push_back({"", x, x + few(random) * o.grid.spacing / n[0], y, y + few(random) * o.grid.spacing / n[1], low,
                       low + height});
      low += height;
    }
    const Prepared made = prepared(o);
    for (int b = 0; b < 3; ++b) {
      const BoxOptions& box = o.box[static_cast<std::size_t>(b)];
      const double volume = (box.east - box.west) * (box.north - box.south) * (box.top - box.bottom);
      EXPECT_NEAR(volume_of(made.domain.points, b) / volume, 1, 1e-12);
      EXPECT_NEAR(made.by_release[static_cast<std::size_t>(b)].second.volume / volume, 1, 1e-6);
    }
  }
}

TEST(laboratory, tilts_its_ground_and_counts_heights_from_it) {
  Options o = bench();
  o.laboratory.ground = 100;
  o.laboratory.slope_x = -0.5;
  o.laboratory.slope_y = 0.25;
  const Domain domain = prepared(o).domain;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 12; ++column)
      ASSERT_NEAR(domain.terrain.at(column, row), 100 - 0.5 * (column + 0.5) + 0.25 * (row + 0.5), 1e-12);
  EXPECT_NEAR(domain.points.height.front(), 0.25, 1e-12);
  EXPECT_NEAR(domain.before.at(4, 4), domain.terrain.at(4, 4) + 2.5, 1e-12);
  EXPECT_NEAR(domain.before.at(3, 4), domain.terrain.at(3, 4) + 1.25, 1e-12);  // half covered
}

TEST(laboratory, writes_a_domain_that_reads_back) {
  test::Scratch scratch;
  Options o = bench();
  o.box.push_back({"lid", 3.5, 6.5, 4, 6, 2.5, 3});
  const Domain domain = prepared(o).domain;
  write_domain(scratch / "domain.vdb", domain);
  const Domain back = read_domain(scratch / "domain.vdb");
  EXPECT_EQ(back.release_names, (std::vector<std::string>{"box-1", "lid"}));
  EXPECT_EQ(back.terrain.values, domain.terrain.values);
  ASSERT_EQ(back.points.size(), domain.points.size());
  for (std::size_t p = 0; p < back.points.size(); ++p) ASSERT_NEAR(back.points.x[p], domain.points.x[p], 1e-6);
}

TEST(laboratory, counts_what_it_would_seed_under_a_sloping_top_too_and_jitters_in_its_seed) {
  Options o = bench();
  EXPECT_EQ(prepare(o, Points::counted).point_count, 6u * 4 * 5);
  const SeedPoints even = prepared(o).domain.points;
  o.grid.jitter = 0.4;
  const SeedPoints shaken = prepared(o).domain.points;
  double largest = 0;
  for (std::size_t p = 0; p < even.size(); ++p) largest = std::max(largest, std::abs(shaken.x[p] - even.x[p]));
  EXPECT_GT(largest, 0.1);
  EXPECT_LE(largest, 0.2);
  EXPECT_NEAR(volume_of(shaken, 0), 15, 1e-12);
  o.grid.jitter = 0;
  o.box[0] = {"", 3, 7, 4, 5, 0, 5};
  o.box[0].top_east = 0;
  EXPECT_EQ(count_box_points(o), seed_boxes(o).size());
  EXPECT_LT(count_box_points(o), 8U * 2 * 10 * 6 / 10);
  Sum thickness;
  const Release release = box_release(o, 0);
  for (const double value : release.thickness.values) thickness.add(value);
  EXPECT_NEAR(thickness.value(), volume_of(seed_boxes(o), 0), 1e-9) << "the map holds what the points stand for";
}

TEST(laboratory, fills_a_box_with_a_sloping_top_up_to_it) {
  // 5 m high in the west; 2 or 8 m in the east, 4 m on.
  for (const double top_east : {2.0, 8.0}) {
    Options o = bench();
    o.box[0] = {"", 3, 7, 4, 5, 0, 5};
    o.box[0].top_east = top_east;
    const Domain domain = prepared(o).domain;
    std::map<double, double> top;
    for (std::size_t p = 0; p < domain.points.size(); ++p) {
      double& highest = top[domain.points.x[p]];
      highest = std::max(highest, domain.points.height[p] + 0.25);
    }
    ASSERT_EQ(top.size(), 8U);
    for (const auto& [x, height] : top) {
      // A point belongs to the box where its place does: a column ends within half a point of the top.
      EXPECT_NEAR(height, 5 + (top_east - 5) * (x - 3) / 4, 0.25 + 1e-9) << x;
    }
    EXPECT_NEAR(volume_of(domain.points, 0), 4 * (5 + top_east) / 2, 1e-9) << "what is left out above is put in below";
  }
}

TEST(laboratory, refuses_a_top_below_the_bottom_and_a_box_that_points_would_not_fill) {
  Options o = bench();
  o.box[0].bottom = 1;
  o.box[0].top_east = 0.5;
  EXPECT_TRUE(test::holds(faults_of(o), {"top_east_m = 0.5"}));
  o = bench();
  o.box[0].east = 6.7;
  test::expect_faults(
      o,
      "[preprocess]: box 1: west to east is 3.2 m (it is no multiple of the points' spacing of 0.5 m, so that "
      "they would not fill it). Take east = 6.5 or 7, or other grid.points_per_cell\n");
}

TEST(laboratory, refuses_boxes_without_extent_outside_the_grid_or_inside_one_another) {
  Options o = bench();
  o.box[0].top = 0;
  test::expect_faults(o, "[preprocess]: box 1: bottom = 0, top = 0 (the box has no extent). top must be the larger\n");
  o = bench();
  o.box[0].west = 0.5;
  test::expect_faults(
      o,
      "[preprocess]: box 1: west = 0.5, east = 6.5 (the grid reaches from 0 to 12 m, and points need an open cell "
      "around them). Add columns or rows, or move the box: a margin of three cells, and room for it to flow into\n");
  o = bench();
  o.box.push_back({"lid", 4, 5, 4, 5, 2, 3});
  test::expect_faults(
      o,
      "[preprocess]: box-1 and lid overlap (the material there would count twice). Move one, or cut it into "
      "boxes that only touch\n");
  o.box[1].name = "box-1";
  test::expect_faults(
      o, "[preprocess]: box 2: name \"box-1\" is taken (results are told apart by name). Name it otherwise\n");
}

TEST(laboratory, refuses_what_belongs_to_the_other_ways) {
  Options o = bench();
  o.base_dem = "dem.tif";
  o.release.resize(1);
  o.working_crs = "EPSG:2056";
  o.grid.extent = {0, 0, 9, 9};
  const std::string mend = "Leave it out, or give elevation models instead of [preprocess.laboratory]\n";
  test::expect_faults(
      o, "[preprocess]: base_dem is given with a laboratory (they belong to different ways). " + mend +
             "[preprocess]: [[preprocess.release]] is given with a laboratory (they belong to different ways). " +
             mend +
             "[preprocess]: working_crs is given with a laboratory (a laboratory lies in local coordinates). Leave "
             "it out\n"
             "[preprocess]: grid.extent_m is given with a laboratory (there is no elevation model to crop). Use "
             "cells and corner_m of the laboratory\n");
}

TEST(laboratory, refuses_half_a_laboratory) {
  Options o = bench();
  o.laboratory.rows = 0;
  o.grid.spacing = 0;
  test::expect_faults(
      o,
      "[preprocess]: laboratory.cells = [12, 0] (both must be positive). Give the number of cells along x and y\n"
      "[preprocess]: grid.spacing_m is not given (a laboratory has no elevation model to take it from). Give the "
      "width of a cell in metres\n");
  o = bench();
  o.box.clear();
  test::expect_faults(
      o,
      "[preprocess]: a laboratory without [[preprocess.box]] (nothing would move). Give at least one box of "
      "material, or no_release = true with [[solve.inflow]]\n");
}

TEST(laboratory, reads_what_it_writes_and_refuses_lists_that_are_too_short) {
  Options o = bench();
  o.laboratory.slope_x = 0.25;
  o.box.push_back({"lid", 4, 5, 4, 5, 2.5, 3});
  test::expect_read_as_written(o);
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("recipe.toml",
                                            "[preprocess.grid]\nspacing_m = 1.0\n[preprocess.laboratory]\n"
                                            "cells = [8]\n[[preprocess.box]]\nextent_m = [1.0, 1.0, 2.0]\n"));
  EXPECT_TRUE(test::holds(test::fault_of<RecipeError>([&] { recipe.read<Options>("preprocess"); }),
                          {"[preprocess.laboratory] cells is too long or too short (it has 2 items",
                           "[[preprocess.box]] extent_m is too long or too short (it has 6 items"}));
}

}  // namespace
}  // namespace talus::preprocess
