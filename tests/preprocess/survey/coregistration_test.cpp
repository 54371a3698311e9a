// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Known shifts of synthetic and real terrain, found again.
#include "preprocess/survey/coregistration.hpp"
#include "common/gis/read_raster.hpp"

#include "common/gis/raster_file.hpp"
#include "tests/preprocess/survey_data.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;

/// Terrain with relief at all widths from a few cells on: a sum of waves whose heights fall with their number.
class Relief {
 public:
  Relief(std::mt19937& random, double longest) {
    std::uniform_real_distribution<double> part(0, 1);
    for (int i = 0; i < 60; ++i) {
      const double number = std::exp(part(random) * std::log(40.0)), angle = 6.2831853 * part(random);
      waves_.push_back({6.2831853 * number / longest * std::cos(angle), 6.2831853 * number / longest * std::sin(angle),
                        6.2831853 * part(random), 0.02 * longest / std::pow(number, 1.2)});
    }
  }
  double operator()(double x, double y) const {
    double z = 1500;
    for (const Wave& w : waves_) z += w.height * std::sin(w.x * (x - 500000) + w.y * (y - 5100000) + w.phase);
    return z;
  }

 private:
  struct Wave {
    double x, y, phase, height;
  };
  std::vector<Wave> waves_;
};

struct Pair {
  Elevation before, after;
  MapGrid grid;
};

struct Alteration {
  double x = 0, y = 0, z = 0, tilt = 0, noise = 0;
  bool slide = false, voids = false;
};

/// A survey and a later one that lies `change` off, both of `cells` x `cells` of 5 m.
Pair pair_of(std::mt19937& random, int cells, const Alteration& change) {
  Pair pair;
  pair.grid = grid_of(cells, cells, 5);
  const Relief relief(random, cells * 5.0);
  std::normal_distribution<double> noise(0, change.noise > 0 ? change.noise : 1);
  const double middle_x = (pair.grid.west + pair.grid.east()) / 2, middle_y = (pair.grid.south + pair.grid.north()) / 2;
  pair.before.raster =
      raster_of(pair.grid, [&](double x, double y) { return relief(x, y) + (change.noise > 0 ? noise(random) : 0); });
  pair.after.raster = raster_of(pair.grid, [&](double x, double y) {
    double z = relief(x - change.x, y - change.y) + change.z + change.tilt * (x - middle_x) +
               (change.noise > 0 ? noise(random) : 0);
    const double far = std::hypot(x - middle_x, y - middle_y) / (0.18 * cells * 5);
    if (change.slide && far < 1) z += (x > middle_x ? 25 : -30) * (1 - far * far);
    if (change.voids && std::fmod(x * 0.37 + y * 0.11, 60) < 4) z = std::nan("");
    return z;
  });
  pair.before.file = "before.tif";
  pair.after.file = "after.tif";
  return pair;
}

Coregistration found(const Pair& pair, bool tilt = false) {
  auto patches = patches_of(pair.before, pair.after, pair.grid);
  find_stable(patches, {});
  return coregister(patches, tilt, "after.tif");
}

/// Share of the variance of noise that six-point interpolation leaves `shift` cells along one axis off the cell
/// centres.
double kept_variance(double shift) {
  double sum = 0;
  for (int k = -2; k <= 3; ++k) {
    double weight = 1;  // Lagrange's
    for (int other = -2; other <= 3; ++other) {
      if (other != k) weight *= (shift - std::floor(shift) - other) / (k - other);
    }
    sum += weight * weight;
  }
  return sum;
}

TEST(coregistration, finds_a_known_sub_pixel_shift_to_a_twentieth_of_a_cell) {
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int i = 0; i < 3; ++i) {
    const Alteration change{
        12 * part(random), 12 * part(random), 3 * part(random), 0, 0.3, true, true};  // up to 2.4 cells
    const Coregistration result = found(pair_of(random, 160, change));
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(result.placement.x, -change.x, 0.05 * 5);
    EXPECT_NEAR(result.placement.y, -change.y, 0.05 * 5);
    EXPECT_NEAR(result.placement.z, -change.z,
                0.05);  // 0.42 m of noise on twenty thousand cells, and the shift's share
    const double noise =
        0.3 * std::sqrt(1 + kept_variance(result.placement.x / 5) * kept_variance(result.placement.y / 5));
    EXPECT_NEAR(result.aligned.nmad / noise, 1,
                0.08);  // within 4 % in 450 draws: cells are few and the rims of the slide blur
    EXPECT_GT(result.unaligned.nmad, result.aligned.nmad);
  }
}

TEST(coregistration, finds_a_shift_of_many_cells_among_narrow_hills) {
  std::mt19937 random(7);
  const Coregistration result = found(pair_of(random, 160, {62, -47, -4, 0, 0.2, true, false}));
  EXPECT_NEAR(result.placement.x, -62, 0.25);
  EXPECT_NEAR(result.placement.y, 47, 0.25);
}

TEST(coregistration, tells_a_tilt_from_noise) {
  std::mt19937 random(3);
  const Coregistration level = found(pair_of(random, 160, {3, 2, 1, 0, 0.3, true, false}), true);
  EXPECT_EQ(level.placement.tilt_x, 0);
  EXPECT_EQ(level.placement.tilt_y, 0);
  const Coregistration tilted = found(pair_of(random, 160, {3, 2, 1, 0.004, 0.3, true, false}), true);
  EXPECT_NEAR(tilted.placement.tilt_x, -0.004, 2e-4);  // 0.16 m over 800 m: a third of the noise
  EXPECT_NEAR(tilted.placement.tilt_y, 0, 2e-4);
  EXPECT_NEAR(tilted.placement.x, -3, 0.25);
}

TEST(coregistration, leaves_identical_surveys_where_they_are) {
  std::mt19937 random(5);
  const Coregistration result = found(pair_of(random, 100, {}), true);
  EXPECT_NEAR(result.placement.x, 0, 1e-9);
  EXPECT_NEAR(result.placement.y, 0, 1e-9);
  EXPECT_NEAR(result.placement.z, 0, 1e-9);
}

TEST(coregistration, finds_no_horizontal_shift_on_a_plain) {
  Pair pair;
  pair.grid = grid_of(60, 60, 5);
  pair.before.raster = raster_of(pair.grid, [](double x, double) { return 100 + 0.1 * (x - 500000); });
  pair.after.raster = raster_of(pair.grid, [](double x, double) { return 101.5 + 0.1 * (x - 500000); });
  const Coregistration result = found(pair);
  EXPECT_FALSE(result.shift_known);
  EXPECT_EQ(result.placement.x, 0);
  EXPECT_NEAR(result.placement.z, -1.5, 1e-9);
}

/// D4 of the validation list: SRTM against itself, blurred and shifted by whole cells and some part of one.
TEST(coregistration, brings_a_shifted_srtm_pair_from_57_m_to_3_m) {
  const auto folder = test::survey_data("coreg_srtm");
  TALUS_NEED_DATA(folder);
  ReadOptions how;
  how.to_crs = utm_crs_of(folder / "srtm_ref.tif");
  const Elevation before = read_elevation("before_dem", folder / "srtm_ref.tif", how);
  const Elevation after = read_elevation("after_dem", folder / "srtm_blurred_and_shifted.tif", how);
  auto patches = patches_of(before, after, before.raster.grid);
  find_stable(patches, {});
  const Coregistration result = coregister(patches, true, after.file);
  std::cerr << "shift " << result.placement.x << " " << result.placement.y << " " << result.placement.z
            << " m, median |dz| " << result.unaligned.median_absolute << " -> " << result.aligned.median_absolute
            << " m, nmad " << result.unaligned.nmad << " -> " << result.aligned.nmad << ", " << result.iterations
            << " iterations, cell " << before.cell() << ", stable " << result.stable_share << "\n";
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.unaligned.median_absolute, 57, 10);  // of stable ground, in metres instead of degrees
  EXPECT_LE(result.aligned.median_absolute, 3);
}

}  // namespace
}  // namespace talus::preprocess
