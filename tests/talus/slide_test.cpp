// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/slide.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::command {
namespace {

Raster filled(int columns, int rows, double cell, double value) {
  const MapGrid grid{columns, rows, 0, 0, cell, ""};
  return {grid, std::vector<double>(grid.count(), value)};
}

/// A plane that falls by 0.5 to the east, cells of 10 m; 10 x 10 cells of 8 m fail at its top, and come to rest 500 m
/// further.
struct Plane {
  Raster before = filled(100, 20, 10, 0), release = before, deposit = before;

  Plane() {
    for (int row = 0; row < 20; ++row) {
      for (int column = 0; column < 100; ++column) {
        before.at(column, row) = 1000 - 5.0 * column;
        if (row >= 5 && row < 15 && column >= 5 && column < 15) release.at(column, row) = 8;
        if (row >= 5 && row < 15 && column >= 55 && column < 65) deposit.at(column, row) = 8;
      }
    }
  }
};

TEST(SlideOfTwoModels, is_measured) {
  const Plane plane;
  const Slide slide = measure_slide(plane.before, plane.release, plane.deposit);
  EXPECT_DOUBLE_EQ(slide.volume, 80000);
  EXPECT_DOUBLE_EQ(slide.area, 10000);
  EXPECT_DOUBLE_EQ(slide.width, 100);  // four times the area over the outline
  EXPECT_DOUBLE_EQ(slide.median_thickness, 8);
  EXPECT_DOUBLE_EQ(slide.crown, 975);
  EXPECT_DOUBLE_EQ(slide.drop, 5.0 * 59);
  EXPECT_NEAR(slide.length, std::hypot(590, 90), 1e-9);  // to the far corner
  // The centre of mass goes 500 m, from 4 m below the ground to 4 m above it: 250 - 8 m down.
  EXPECT_NEAR(slide.travel_tangent, 242.0 / 500, 1e-9);
}

TEST(SlideOfTwoModels, without_a_deposit_is_known_by_its_volume) {
  const Plane plane;
  const Slide slide = measure_slide(plane.before, plane.release, std::nullopt);
  EXPECT_FALSE(slide.has_deposit());
  const Proposal p = propose(slide);
  const double usual = std::atan(usual_reach_tangent(80000)) * 180 / 3.14159265358979;
  EXPECT_NEAR(p.bed_angle, usual, 0.25);  // to half a degree
  EXPECT_GT(p.end_time, 10);
}

TEST(SlideOfTwoModels, gives_four_layers_and_eight_cells_at_least) {
  for (const double cell : {0.5, 2.0, 10.0, 30.0}) {
    for (const double width : {12.0, 100.0, 3000.0}) {
      for (const double thickness : {0.3, 4.0, 90.0}) {
        Slide slide;
        slide.cell = cell;
        slide.width = width;
        slide.median_thickness = thickness;
        slide.area = width * width;
        slide.volume = slide.area * thickness;
        const Proposal p = propose(slide);
        EXPECT_GE(p.layers, 4) << cell << " " << width << " " << thickness;
        EXPECT_GE(p.cells_across, 8 - 1e-9) << cell << " " << width << " " << thickness;
        EXPECT_LE(p.layer_height, p.spacing);
        EXPECT_GT(p.bed_angle, 0);
        EXPECT_GT(p.internal_angle, p.bed_angle);
      }
    }
  }
}

}  // namespace
}  // namespace talus::command
