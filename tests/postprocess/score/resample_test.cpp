// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/resample.hpp"

#include "common/map/statistics.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::small_grid;

/// small_run() against its own deposit, known to `sigma` where something was measured.
struct Setting {
  talus::Run run = test::small_run();
  Options options;
  Survey survey;
  Thalweg thalweg;

  explicit Setting(double sigma, double range = 0) {
    survey.name = "made by hand";
    survey.grid = small_grid();
    survey.measured = survey.deposit = run.maps.deposit_thickness;
    survey.error = {std::vector<double>(survey.grid.count(), sigma), range, 1.96};
    options.deposit_threshold = 0.5;
    options.survey.resamples = 400;
    thalweg = thalweg_of(run, options);
  }
  Resampled draw() const {
    Scored scored{run, options, &survey, thalweg, crown(run.maps, 1), 0};
    return resample(scored, bring_to_survey_grid(run.maps, survey));
  }
};

TEST(Resample, has_no_spread_without_an_error) {
  const auto all = Setting(0).draw();
  ASSERT_EQ(all.deposit_csi.size(), 400u);
  EXPECT_EQ(spread_of(all.deposit_csi).low, 1);
  EXPECT_EQ(spread_of(all.rmse).high, 0);
  EXPECT_EQ(spread_of(all.volume).deviation, 0);
  EXPECT_EQ(spread_of(all.runout_difference).high, 0);
  EXPECT_TRUE(all.footprint_csi.empty()) << "a thickness says nothing of the footprint";
}

TEST(Resample, carries_the_error_into_volume_bias_and_rmse) {
  // 100 cells of 100 m2, at 1.5 m or more, off by 0.2 m each for itself: no cell falls under the threshold of 0.5 m.
  const auto all = Setting(0.2).draw();
  const double sigma_volume = 0.2 * 100 * std::sqrt(100.0);
  EXPECT_NEAR(spread_of(all.volume).deviation, sigma_volume,
              0.15 * sigma_volume);  // 400 draws: a standard error of 3.5 %
  EXPECT_NEAR(spread_of(all.volume).mean, 24000, 4 * sigma_volume / 20);
  EXPECT_NEAR(spread_of(all.bias).deviation, 0.2 / 10, 0.15 * 0.2 / 10);
  EXPECT_NEAR(spread_of(all.rmse).mean, 0.2, 0.01);
  EXPECT_EQ(spread_of(all.deposit_csi).low, 1);
}

TEST(Resample, spreads_the_volume_more_where_errors_are_alike) {
  // Spherical correlation of range 1 km over a deposit of 100 m: all cells go together, up to a few per cent.
  const auto alike = spread_of(Setting(0.2, 1000).draw().volume);
  EXPECT_NEAR(alike.deviation, 0.2 * 100 * 100, 0.25 * 0.2 * 100 * 100) << "mean correlation about 0.92, 400 draws";
}

TEST(Resample, lowers_the_agreement_where_the_deposit_is_hardly_above_the_error) {
  auto setting = Setting(0.7, 30);  // 1.5 m of deposit, a level of detection of 1.37 m
  const auto csi = spread_of(setting.draw().deposit_csi);
  EXPECT_LT(csi.high, 1);
  EXPECT_GT(csi.low, 0.3);
  EXPECT_GT(csi.deviation, 0.01);
  setting.survey.error.detection = 0;
  EXPECT_GT(spread_of(setting.draw().deposit_csi).mean, csi.mean) << "without a level of detection less is lost";
}

TEST(Resample, is_the_same_each_time) {
  auto setting = Setting(0.7, 30);
  EXPECT_EQ(setting.draw().deposit_csi, setting.draw().deposit_csi);
}

TEST(Resample, takes_no_noise_far_away_for_run_out) {
  // Ground measured as 0.01 m everywhere, so that it is drawn too: some of it rises above the threshold in every draw.
  auto setting = Setting(0.7);
  setting.survey.error.detection = 0;
  for (double& v : setting.survey.measured) v = v == 0 ? 0.01 : v;
  const auto all = setting.draw();
  EXPECT_LT(spread_of(all.deposit_csi).high, 0.5) << "a fifth of the dry ground is above 0.5 m now";
  setting.survey.error.sigma.assign(setting.survey.grid.count(), 0.2);
  const auto quiet = setting.draw();
  // 0.7 % of the ground is above the threshold; the eastern edge is 50 m beyond the deposit's.
  EXPECT_GE(spread_of(quiet.runout_difference).low, -25) << "a cell or two where noise touches the deposit";
  EXPECT_LT(spread_of(quiet.deposit_csi).mean, 1);
}

TEST(Patches, keeps_those_that_hold_a_seed) {
  const MapGrid grid{.columns = 4, .rows = 3, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  const std::vector<double> values{5, 0, 0,   4,  //
                                   0, 5, 0,   4,  //
                                   0, 0, 0.5, 0};
  std::vector<char> seeds(12, 0);
  seeds[0] = seeds[2] = 1;                      // the second on a cell below the threshold: no patch
  const std::vector<double> kept{5, 0, 0,   0,  //
                                 0, 5, 0,   0,  //
                                 0, 0, 0.5, 0};
  EXPECT_EQ(patches_with(grid, values, 1, seeds), kept) << "corners join, values below the threshold stay as they are";
}

}  // namespace
}  // namespace talus::postprocess
