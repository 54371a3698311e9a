// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which changed ground belongs to a slide: made ones with split deposits, neighbours and noise, and all pairs of
// surveys at hand.

#include "tests/preprocess/scene.hpp"
#include "tests/preprocess/survey_data.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;
using test::Scratch;

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
    options.before_dem = test::write(scratch, "before.tif", surface({}));
    options.after_dem = test::write(scratch, "after.tif", surface(caps));
  }

  double volume(const Cap& cap) const {
    return test::volume_of(
        raster_of(grid, [&](double x, double y) { return std::abs(cap.at(x - grid.west, y - grid.south)); }));
  }
  SurveyedSlide slide() const { return *prepare(options, Points::counted).slide; }
};

double deposit_of(const SurveyedSlide& slide) { return slide.volumes.at(1).volume.volume; }

// 2 %: the rim thinner than threshold_m, which is (0.5 / 6)^2 of a paraboloid, and as much for the cells' size.
TEST(delineation, a_far_lobe_down_the_valley_belongs_to_the_slide) {
  const MadeSlide made({}, {scar, near_lobe, far_lobe});
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(deposit_of(slide) / (made.volume(near_lobe) + made.volume(far_lobe)), 1, 0.02);
  EXPECT_EQ(slide.outside.rise, 0);
  EXPECT_FALSE(slide.outside_is_large);
}

TEST(delineation, a_gap_longer_than_allowed_leaves_the_lobe_outside_and_says_how_much_it_is) {
  MadeSlide made({}, {scar, near_lobe, far_lobe});
  made.options.deposit.longest_gap = 0.2;  // the gap is 24 cells, and the slide has come 34 by then
  const SurveyedSlide slide = made.slide();
  EXPECT_NEAR(deposit_of(slide) / made.volume(near_lobe), 1, 0.02);
  EXPECT_NEAR(slide.outside.sure_rise / made.volume(far_lobe), 1, 0.02);
  EXPECT_TRUE(slide.outside_is_large);
  EXPECT_TRUE(test::holds(outside_words(slide), {"draw the deposit"}));
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
TEST(delineation, a_bridge_does_not_cross_a_ridge) {
  const Cap small_scar{150, 1300, 30, -12}, lobe{150, 1050, 30, 6}, other{250, 1050, 30, 6};
  const Valleys narrow{.fall = 0.2, .flank = 0.8, .apart = 100};
  const MadeSlide made(narrow, {small_scar, lobe, other});
  EXPECT_NEAR(deposit_of(made.slide()) / made.volume(lobe), 1, 0.05);  // a lobe of 28 cells has more rim
}

/// Nothing rests on ground of 35 degrees: 700 m of it are no gap.
TEST(delineation, a_lobe_below_a_long_steep_face_belongs_to_the_slide) {
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
  Options options;
  options.before_dem = folder / "before_dem.tif";
  options.after_dem = folder / "after_dem.tif";
  return options;
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
