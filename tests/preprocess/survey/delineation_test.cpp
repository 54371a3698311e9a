// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which changed ground belongs to a slide: made ones with split deposits, neighbours and noise, and all pairs of
// surveys at hand.
#include "preprocess/survey/patches.hpp"
#include "tests/common/findings.hpp"
#include "tests/preprocess/scene.hpp"
#include "tests/preprocess/survey_data.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;
using test::Scratch;

constexpr int width = 60, height = 50;
const MapGrid grid = test::grid_of(width, height, 5);

/// A slope and its noisy repeat, raised by 5 m in a window.
std::vector<Patch> raised(const CellWindow& w, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.1);
  Elevation before, after;
  before.raster = test::raster_of(grid, [](double x, double y) { return 0.3 * (x - 500000) - 0.2 * (y - 5100000); });
  after.raster = before.raster;
  for (double& z : after.raster.values) z += noise(random);
  for (int row = w.row; row < w.row + w.rows; ++row)
    for (int column = w.column; column < w.column + w.columns; ++column) after.raster.at(column, row) += 5;
  return patches_of(before, after, grid);
}

/// The change is out, what is further than four cells from it stays: three cells are left out around it, and noise at
/// its side may widen it by one.
void expect_left_out(const CellWindow& w) {
  std::vector<Patch> patches = raised(w, 1);
  leave_out_changed(patches, {});
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const int far =
          std::max({w.column - column, column - (w.column + w.columns - 1), w.row - row, row - (w.row + w.rows - 1)});
      const std::size_t i = grid.index(column, row);
      if (far > 0 && far <= 4) continue;
      EXPECT_EQ(patches[0].unchanged[i] + patches[0].stable[i], far > 0 ? 2 : 0) << column << ", " << row;
    }
}

/// Two cells deep and fifteen along: a change, though those of its cells that are not at the edge are too few for one.
TEST(changed_cells, are_left_out_inside_the_map_at_its_edge_and_in_its_corners) {
  expect_left_out({20, 20, 8, 8});
  expect_left_out({20, 0, 15, 2});
  expect_left_out({20, height - 2, 15, 2});
  expect_left_out({0, 20, 2, 15});
  expect_left_out({width - 2, 20, 2, 15});
  expect_left_out({0, 0, 5, 5});
  expect_left_out({width - 5, height - 5, 5, 5});
}

TEST(changed_cells, too_few_to_be_more_than_noise_stay) {
  for (const CellWindow& w : {CellWindow{20, 20, 3, 3}, {0, 0, 3, 3}, {30, 0, 6, 2}}) {
    std::vector<Patch> patches = raised(w, 2);
    leave_out_changed(patches, {});
    EXPECT_EQ(std::count(patches[0].unchanged.begin(), patches[0].unchanged.end(), 1), width * height);
  }
}

/// A heap, or a scar where its height is negative: a paraboloid.
struct Cap {
  double x, y, radius, height;  ///< from the corner of the map [m]
  double at(double px, double py) const {
    return height * std::max(0.0, 1 - ((px - x) * (px - x) + (py - y) * (py - y)) / (radius * radius));
  }
};

/// Valleys side by side that fall to the south, with their ways down `apart` from one another.
struct Valleys {
  double fall = 0.2, flank = 0.3, apart = 300;
  double at(double x, double y) const { return 1000 + fall * y + flank * std::abs(std::remainder(x - 150, apart)); }
};

constexpr Cap scar{150, 1300, 45, -12}, near_lobe{150, 1050, 45, 6}, far_lobe{150, 720, 45, 6};

struct MadeSlide {
  Scratch scratch;
  MapGrid grid = grid_of(60, 150, 10);
  Options options;

  MadeSlide(const Valleys& valleys, const std::vector<Cap>& caps, double noise = 0) {
    std::mt19937 random(7);
    std::normal_distribution<double> error(0, 1);
    const auto surface = [&](const std::vector<Cap>& changes) {
      return raster_of(grid, [&](double x, double y) {
        double z = valleys.at(x - grid.west, y - grid.south) + noise * error(random);
        for (const Cap& cap : changes) z += cap.at(x - grid.west, y - grid.south);
        return z;
      });
    };
    const auto before = test::write(scratch, "before.tif", surface({}));
    options = test::two_models(before, test::write(scratch, "after.tif", surface(caps)));
    options.source.seed = {grid.west + scar.x, grid.south + scar.y};
  }

  double volume(const Cap& cap) const {
    return test::volume_of(
        raster_of(grid, [&](double x, double y) { return std::abs(cap.at(x - grid.west, y - grid.south)); }));
  }
  SurveyedSlide slide() const { return *prepare(options, Points::counted).slide; }
};

double deposit_of(const SurveyedSlide& slide) { return slide.volumes.at(1).volume.volume; }

// 2 %: the rim thinner than threshold_m, which is (0.5 / 6)^2 of a paraboloid, and as much for the cells' size.
TEST(delineation, a_far_lobe_down_the_valley_belongs_to_the_slide_unless_the_gap_is_longer_than_allowed) {
  MadeSlide made({}, {scar, near_lobe, far_lobe});
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(deposit_of(slide) / (made.volume(near_lobe) + made.volume(far_lobe)), 1, 0.02);
  EXPECT_EQ(slide.outside.rise, 0);
  EXPECT_FALSE(slide.outside_is_large);
  made.options.deposit.longest_gap = 0.2;  // the gap is 24 cells, and the slide has come 34 by then
  const SurveyedSlide near = made.slide();
  EXPECT_NEAR(deposit_of(near) / made.volume(near_lobe), 1, 0.02);
  EXPECT_NEAR(near.outside.sure_rise / made.volume(far_lobe), 1, 0.02);
  EXPECT_TRUE(near.outside_is_large);
  EXPECT_TRUE(test::holds(outside_words(near), {"draw the deposit"}));
}

TEST(delineation, a_deposit_that_the_edge_of_the_map_cuts_is_said) {
  MadeSlide made({}, {scar, near_lobe});
  const auto is_said = [&] {
    return std::ranges::count(test::findings_of([&] { made.slide(); }), "deposit-cut", &Finding::name) == 1;
  };
  EXPECT_FALSE(is_said());
  made.options.grid.extent = {made.grid.west, made.grid.south + near_lobe.y, made.grid.east(), made.grid.north()};
  EXPECT_TRUE(is_said());
}

/// Heaps of four cells each stand out, and are noise by the number of their cells; together they are much of the slide.
TEST(delineation, much_within_reach_that_counts_as_noise_is_said_with_its_volume) {
  std::vector<Cap> caps{scar, near_lobe};
  double heaps = 0;
  for (const double y : {700, 760, 820, 880, 940})
    for (const double x : {90, 150, 210}) caps.push_back({x, y, 14, 8});
  MadeSlide made({}, caps);
  made.options.difference.sigma = 0.3;
  for (std::size_t c = 2; c < caps.size(); ++c) heaps += made.volume(caps[c]);
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(slide.near.rise / heaps, 1, 0.1) << "cells at their rims lie below the level";
  EXPECT_TRUE(slide.outside_is_doubtful);
  EXPECT_TRUE(test::holds(outside_words(slide), {"within reach of the slide"}));
  made.options.deposit.sure_cells = 2;
  EXPECT_FALSE(made.slide().outside_is_doubtful) << "fewer cells count as noise";
}

TEST(delineation, a_lobe_in_the_next_valley_does_not_belong_to_the_slide) {
  const Cap other{450, 720, 45, 6};
  const SurveyedSlide slide = MadeSlide({}, {scar, near_lobe, other}).slide();
  EXPECT_NEAR(slide.outside.sure_rise / MadeSlide({}, {other, scar}).volume(other), 1, 0.02);
  EXPECT_TRUE(slide.outside_is_large) << "nothing fell there";
}

/// The next slide has a scar of its own: what rose is explained by what fell.
TEST(delineation, a_slide_beside_it_is_outside_and_explained) {
  const Cap its_scar{450, 1300, 40, -8}, its_lobe{450, 1050, 40, 8};
  const MadeSlide made({}, {scar, near_lobe, far_lobe, its_scar, its_lobe});
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(deposit_of(slide) / (made.volume(near_lobe) + made.volume(far_lobe)), 1, 0.02);
  EXPECT_NEAR(slide.outside.sure_rise / made.volume(its_lobe), 1, 0.02);
  EXPECT_FALSE(slide.outside_is_large);
}

/// 40 m apart are four cells, well within the bridge; but a ridge of 40 m stands between them.
/// Nothing rests on ground of 35 degrees: 700 m of it are no gap.
TEST(delineation, a_bridge_does_not_cross_a_ridge_and_a_lobe_below_a_long_steep_face_belongs_to_the_slide) {
  const Cap small_scar{150, 1300, 30, -12}, lobe{150, 1050, 30, 6}, other{250, 1050, 30, 6};
  const Valleys narrow{.fall = 0.2, .flank = 0.8, .apart = 100};
  const MadeSlide made(narrow, {small_scar, lobe, other});
  EXPECT_NEAR(deposit_of(made.slide()) / made.volume(lobe), 1, 0.05);  // a lobe of 28 cells has more rim
  const Cap foot{150, 400, 45, 6};
  EXPECT_GT(deposit_of(MadeSlide({.fall = 0.7, .flank = 0.05}, {scar, foot}).slide()), 0);
  EXPECT_EQ(deposit_of(MadeSlide({.fall = 0.2, .flank = 0.05}, {scar, foot}).slide()), 0);
}

TEST(delineation, single_cells_of_change_belong_to_the_slide_where_there_is_no_noise) {
  const Cap stone{155, 905, 8, 2};  // one cell
  const MadeSlide made({}, {scar, near_lobe, far_lobe, stone});
  EXPECT_NEAR(deposit_of(made.slide()) - deposit_of(MadeSlide({}, {scar, near_lobe, far_lobe}).slide()), 200, 1e-3);
}

/// 5 %: of a paraboloid of 6 m what lies below the level of detection of 0.83 m is 2 %, and the fringe as much again.
TEST(delineation, noise_neither_joins_nor_parts_what_belongs_together) {
  const Cap other{450, 720, 45, 6};
  const MadeSlide made({}, {scar, near_lobe, far_lobe, other}, 0.3);
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(deposit_of(slide) / (made.volume(near_lobe) + made.volume(far_lobe)), 1, 0.05);
  EXPECT_NEAR(slide.outside.sure_rise / made.volume(other), 1, 0.05);
  EXPECT_GT(slide.outside.rise, 1.2 * slide.outside.sure_rise) << "of all cells a twentieth is beyond its level";
}

Options pair_in(const std::filesystem::path& folder) {
  return test::two_models(folder / "before_dem.tif", folder / "after_dem.tif");
}

/// The surveyed change of SOURCE.md: 22,543 m3 of rise in 130 cells, all of it in one run-out of 800 m.
TEST(delineation, cascades_deposit_is_all_of_its_surveyed_rise) {
  const auto folder = test::survey_data("cascade2021");
  TALUS_NEED_DATA(folder);
  Options options = pair_in(folder);
  SurveyedSlide slide = *prepare(options, Points::counted).slide;
  EXPECT_NEAR(deposit_of(slide), 21834, 1);  // beyond threshold_m = 0.5
  EXPECT_EQ(slide.outside.rise + slide.outside.fall, 0);
  options.deposit.threshold = 0;
  slide = *prepare(options, Points::counted).slide;
  EXPECT_NEAR(deposit_of(slide), 22543, 1);
  options.deposit.threshold = 0.5;
  options.difference.sigma = std::hypot(0.15, 0.15);  // of airborne lidar on such ground
  slide = *prepare(options, Points::counted).slide;
  EXPECT_GT(deposit_of(slide), 0.9 * 22060);  // what is beyond its level of detection; the rest is in single cells
  EXPECT_FALSE(slide.outside_is_large);
}

/// How much of the change outside the slide its samples allow.
TEST(delineation, samples_have_the_deposit_of_their_scar_and_nothing_outside) {
  const auto samples = std::filesystem::path(TALUS_SOURCE_DIR) / "data_samples";
  for (const char* name : {"valley", "raw-valley", "rock-slope"}) {
    Options options = pair_in(samples / name);
    options.coregistration.mode = Alignment::apply;
    options.voids.fill = 1e5;
    if (std::string(name) == "rock-slope") options.source.seed = {400475, 5200785};
    const SurveyedSlide slide = *prepare(options, Points::counted).slide;
    EXPECT_EQ(slide.outside.sure_rise + slide.outside.sure_fall, 0) << name;
    EXPECT_FALSE(slide.outside_is_large) << name;
    const double deposit = deposit_of(slide), source = slide.volumes.at(0).volume.volume;
    if (std::string(name) == "rock-slope")
      EXPECT_EQ(deposit, 0) << "this sample has a scar only";
    else
      EXPECT_NEAR(deposit / source, 1, 0.02) << name;
  }
}

}  // namespace
}  // namespace talus::preprocess
