// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Known shifts of synthetic and real terrain, found again.
#include <numbers>

#include "common/gis/raster_file.hpp"
#include "common/map/fourier.hpp"
#include "common/map/raster.hpp"
#include "preprocess/survey/coregistration.hpp"
#include "preprocess/survey/patches.hpp"
#include "preprocess/survey/survey.hpp"
#include "tests/preprocess/scene.hpp"
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
    for (int other = -2; other <= 3; ++other)
      if (other != k) weight *= (shift - std::floor(shift) - other) / (k - other);
    sum += weight * weight;
  }
  return sum;
}

TEST(coregistration, finds_a_known_sub_pixel_shift_to_a_twentieth_of_a_cell) {
  test::Seeded random;
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

TEST(coregistration, leaves_identical_surveys_where_they_are_and_finds_no_shift_on_a_plain) {
  std::mt19937 random(5);
  const Coregistration same = found(pair_of(random, 100, {}), true);
  EXPECT_NEAR(same.placement.x, 0, 1e-9);
  EXPECT_NEAR(same.placement.y, 0, 1e-9);
  EXPECT_NEAR(same.placement.z, 0, 1e-9);
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

using Spectrum = std::vector<std::complex<double>>;

/// Waves a post along a line of transformed values: counted from -count / 2.
double waves_of(int i, int count) { return i <= count / 2 ? i : i - count; }

/// Gaussian noise of mean 0 and standard deviation 1, independent or (length > 0, in cells) alike over some cells.
std::vector<double> noise_field(std::mt19937& random, int cells, double length) {
  std::normal_distribution<double> normal;
  const auto count = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
  Spectrum plane(count);
  for (auto& value : plane) value = normal(random);
  fourier_transform(plane, cells, cells);
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const double k = 2 * std::numbers::pi * std::hypot(waves_of(column, cells), waves_of(row, cells)) / cells;
      plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells) + static_cast<std::size_t>(column)] *=
          std::exp(-k * k * length * length / 2);
    }
  inverse_fourier_transform(plane, cells, cells);
  std::vector<double> field;
  double squares = 0;
  for (const auto& value : plane) field.push_back(value.real()), squares += value.real() * value.real();
  for (double& value : field) value /= std::sqrt(squares / static_cast<double>(count));
  return field;
}

/// Fractal terrain on a torus, eight times as fine as the posts taken of it: what is shorter than two posts is folded
/// into what they show, as on a mountain.
class FractalTerrain {
 public:
  FractalTerrain(std::mt19937& random, int posts, double hurst) : posts_(posts), fine_(8 * posts) {
    std::normal_distribution<double> normal;
    waves_.resize(static_cast<std::size_t>(fine_) * static_cast<std::size_t>(fine_));
    for (auto& value : waves_) value = normal(random);
    fourier_transform(waves_, fine_, fine_);
    for (int row = 0; row < fine_; ++row)
      for (int column = 0; column < fine_; ++column) {
        const double number = std::hypot(waves_of(column, fine_), waves_of(row, fine_));
        at(waves_, column, row) *= number > 0 ? std::pow(number, -hurst - 1) : 0;
      }
  }

  /// Heights of the posts [m], the terrain moved by a part of a post; slopes along a line are 0.25 (rms) at posts of
  /// `post` metres.
  std::vector<double> posts(double east, double north, double post) const {
    Spectrum moved = waves_;
    for (int row = 0; row < fine_; ++row)
      for (int column = 0; column < fine_; ++column) {
        const double turn =
            -2 * std::numbers::pi * (waves_of(column, fine_) * east + waves_of(row, fine_) * north) / posts_;
        at(moved, column, row) *= std::polar(1.0, turn);
      }
    inverse_fourier_transform(moved, fine_, fine_);
    std::vector<double> heights;
    double squares = 0;
    for (int row = 0; row < fine_; row += 8)
      for (int column = 0; column < fine_; column += 8) heights.push_back(at(moved, column, row).real());
    for (std::size_t i = 1; i < heights.size(); ++i) squares += std::pow(heights[i] - heights[i - 1], 2);
    const double scale = 0.25 * post / std::sqrt(squares / static_cast<double>(heights.size()));
    for (double& z : heights) z = 1500 + z * scale;
    return heights;
  }

 private:
  std::complex<double>& at(Spectrum& plane, int column, int row) const {
    return plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(fine_) + static_cast<std::size_t>(column)];
  }

  int posts_, fine_;
  Spectrum waves_;
};

struct Noise {
  double size, length;  // [m], [cells]
};

void add_noise(std::vector<double>& heights, std::mt19937& random, int posts, const Noise& noise) {
  const std::vector<double> field = noise_field(random, posts, noise.length);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += noise.size * field[i];
}

Coregistration aligned(const MapGrid& grid, std::vector<double> before, std::vector<double> after) {
  Elevation first, second;
  first.raster = {grid, std::move(before)};
  second.raster = {grid, std::move(after)};
  auto patches = patches_of(first, second, grid);
  find_stable(patches, {});
  return coregister(patches, false, "after.tif");
}

/// Errors of shifts [cells] and over their stated errors, of many pairs.
struct Tally {
  double worst = 0, worst_stated = 0, squares = 0;
  int count = 0;

  void add(const Coregistration& found, double cell, double east, double north) {
    const std::array<double, 2> off{-found.placement.x / cell - east, -found.placement.y / cell - north};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double stated = off[axis] / (found.shift_error[axis] / cell);
      worst = std::max(worst, std::abs(off[axis]));
      worst_stated = std::max(worst_stated, std::abs(stated));
      squares += stated * stated;
      ++count;
    }
  }

  void expect_right(double least_rms = 0.5) const {
    const double rms = std::sqrt(squares / count);
    std::cerr << "shifts off by at most " << worst << " cells, " << worst_stated << " stated errors (rms " << rms
              << ")\n";
    EXPECT_LE(worst, 0.1);
    EXPECT_LE(worst_stated, 3);
    EXPECT_GE(rms, least_rms);
    EXPECT_LE(rms, 2);
  }
};

/// Posts of 190 m: six pairs for each kind of noise. Of 96 pairs of such terrain the worst was 0.05 cells off; by
/// slopes of single cells alone, with noise alike over three cells, 0.24.
TEST(refined_shift, is_right_to_a_tenth_of_a_cell_between_coarse_posts_of_fractal_terrain) {
  constexpr int posts = 48;
  constexpr double post = 190;
  Tally tally;
  for (const Noise& noise : {Noise{5, 0}, Noise{20, 0}, Noise{5, 6}, Noise{20, 3}})
    for (unsigned seed = 1; seed <= 6; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> part(-1.2, 1.2);
      const double east = part(random), north = part(random);
      const FractalTerrain terrain(random, posts, 0.8);
      std::vector<double> before = terrain.posts(0, 0, post), after = terrain.posts(east, north, post);
      add_noise(before, random, posts, noise);
      add_noise(after, random, posts, noise);
      tally.add(aligned(grid_of(posts, posts, post), before, after), post, east, north);
    }
  tally.expect_right();
}

/// Rough terrain between whole cells, without noise: what posts cannot show pulls towards whole cells. The stated error
/// has to know of it.
TEST(refined_shift, states_what_posts_too_coarse_for_their_terrain_add_to_its_error) {
  Tally tally;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const FractalTerrain terrain(random, 48, 0.4);
    tally.add(aligned(grid_of(48, 48, 190), terrain.posts(0, 0, 190), terrain.posts(0.25, -0.3, 190)), 190, 0.25, -0.3);
  }
  tally.expect_right();
}

TEST(refined_shift, says_when_it_is_not_known_to_a_tenth_of_a_cell) {
  test::Scene scene;
  std::mt19937 random(3);
  const MapGrid grid = grid_of(32, 32, 30);
  const FractalTerrain terrain(random, 32, 0.8);
  Raster before{grid, terrain.posts(0, 0, 30)}, after{grid, terrain.posts(0.4, 0.2, 30)};
  add_noise(before.values, random, 32, {20, 0});
  add_noise(after.values, random, 32, {20, 0});
  scene.rewrite_before(before);
  scene.rewrite_after(after);
  scene.options.coregistration.mode = Alignment::apply;
  testing::internal::CaptureStderr();
  const Survey survey = survey_of(scene.options);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_GT(std::max(survey.fit.shift_error[0], survey.fit.shift_error[1]), 0.1 * 30);
  EXPECT_TRUE(test::holds(said, {"its shift on the map is known to", " +- "}));
  EXPECT_TRUE(test::holds(survey_json(survey, {}, {}), {"after_lies_error_cells"}));
}

/// Filling is linear in the values, and keeps those that count.
TEST(smooth_fill, fills_two_fields_and_their_sum_alike) {
  constexpr int columns = 21, rows = 13;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> a, b, sum;
  std::vector<char> counts;
  for (int i = 0; i < columns * rows; ++i) {
    counts.push_back(i % 7 != 0 && (i < 80 || i > 160));
    a.push_back(counts.back() ? normal(random) : std::nan(""));
    b.push_back(5 + 0.1 * i);
    sum.push_back(2 * a.back() + b.back());
  }
  const auto filled_a = smooth_fill(a, counts, columns, rows), filled_b = smooth_fill(b, counts, columns, rows),
             filled = smooth_fill(sum, counts, columns, rows);
  for (std::size_t i = 0; i < filled.size(); ++i) {
    ASSERT_NEAR(filled[i], 2 * filled_a[i] + filled_b[i], 1e-12);
    if (counts[i]) {
      ASSERT_EQ(filled[i], sum[i]);
    }
    ASSERT_GT(filled_b[i], 5 - 1e-12);  // between the least and the largest around
    ASSERT_LT(filled_b[i], 5 + 0.1 * columns * rows);
  }
}

/// SRTM (90 m) taken at posts of 190 m between its own, with noise alike over three posts and without.
TEST(refined_shift, is_right_to_a_tenth_of_a_cell_between_posts_of_190_m_of_srtm) {
  const auto file = test::survey_data("coreg_srtm/srtm_ref.tif");
  TALUS_NEED_DATA(file);
  ReadOptions how;
  how.to_crs = utm_crs_of(file);
  const RasterFile source(file, how);
  const Raster srtm = source.read({0, 0, source.grid().columns, source.grid().rows});
  constexpr int posts = 80;
  constexpr double post = 190, rim = 4000;  // the rim: cells without data where the map was turned
  const MapGrid grid = grid_of(posts, posts, post);
  Tally tally;
  for (const Noise& noise : {Noise{5, 0}, Noise{20, 0}, Noise{20, 3}})
    for (unsigned seed = 1; seed <= 8; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> part(-1.2, 1.2), corner(0, 1);
      const double east = part(random), north = part(random), reach = posts * post + 2 * rim;
      const double x = srtm.grid.west + rim + corner(random) * (srtm.grid.columns * srtm.grid.cell - reach),
                   y = srtm.grid.south + rim + corner(random) * (srtm.grid.rows * srtm.grid.cell - reach);
      std::vector<double> before, after;
      for (int row = 0; row < posts; ++row)
        for (int column = 0; column < posts; ++column) {
          before.push_back(biquintic(srtm, x + column * post, y + row * post));
          after.push_back(biquintic(srtm, x + (column - east) * post, y + (row - north) * post));
        }
      add_noise(before, random, posts, noise);
      add_noise(after, random, posts, noise);
      tally.add(aligned(grid, before, after), post, east, north);
    }
  tally.expect_right(0.3);  // SRTM has no waves shorter than 180 m: less is folded than its longer waves let expect
}

}  // namespace
}  // namespace talus::preprocess
