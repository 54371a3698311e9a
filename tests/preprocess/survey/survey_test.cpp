// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Difference of two surveys: its error, its volumes, what of it is the slide.
#include "preprocess/survey/survey.hpp"
#include "common/gis/features.hpp"
#include "common/gis/raster_file.hpp"

#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "data_samples/terrains.hpp"
#include "preprocess/output/write_survey.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::holds;
using test::raster_of;
using test::Scratch;

/// The valley's volume, which its formula gives: cells of 10 m sum a smooth scar and lobe to 0.2 %.
double clean_volume() {
  const samples::Sample clean = samples::valley(10);
  double sum = 0;
  for (std::size_t i = 0; i < clean.rasters[0].second.values.size(); ++i)
    sum += std::max(0.0, clean.rasters[0].second.values[i] - clean.rasters[1].second.values[i]);
  return sum * 100;
}

Options raw_options(const Scratch& scratch, unsigned seed) {
  const samples::Sample raw = samples::raw_valley(10, seed);
  Options options = test::two_models(test::write(scratch, "before.tif", raw.rasters[0].second),
                                     test::write(scratch, "after.tif", raw.rasters[1].second));
  options.coregistration.mode = Alignment::apply;
  options.voids.fill = 1e5;
  return options;
}

using survey = test::WithScene;

/// Eight surveys of the same slide. Their holes are the same, so that errors of filling do not average out: the errors
/// are not expected to be centred, but to be as large as said.
TEST_F(survey, recovers_shift_and_volumes_of_a_raw_pair_within_their_stated_errors) {
  const double truth = clean_volume();
  double squares = 0, worst = 0, shift = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Scratch scratch;
    const Prepared prepared = preprocess::prepare(raw_options(scratch, seed), Points::counted);
    const Placement& p = prepared.survey->fit.placement;
    EXPECT_NEAR(p.x, -4, 0.1 * 10) << "seed " << seed;
    EXPECT_NEAR(p.y, 7, 0.1 * 10);
    EXPECT_NEAR(p.z, -1.3, 0.1);
    shift = std::max(shift, std::hypot(p.x + 4, p.y - 7) / 10);
    for (const SurveyedVolume& side : prepared.slide->volumes) {
      const double off = (side.volume.volume - truth) / side.volume.error;
      EXPECT_LT(std::abs(off), 2.6) << side.name << ", seed " << seed;  // 1 in 100 by chance
      EXPECT_LT(side.volume.error, 0.02 * truth);
      squares += off * off / 16;
      worst = std::max(worst, std::abs(off));
    }
  }
  std::cerr << "volumes off by " << std::sqrt(squares) << " stated errors (rms), at most " << worst
            << "; shift by at most " << shift << " cells\n";
  EXPECT_GT(std::sqrt(squares), 0.4);  // errors neither far too large
  EXPECT_LT(std::sqrt(squares), 1.5);  // nor far too small
}

TEST_F(survey, warns_and_leaves_the_later_model_where_it_is_unless_told) {
  Scratch scratch;
  Options options = raw_options(scratch, 1);
  options.coregistration.mode = Alignment::check;
  const Survey survey = survey_of(options);
  EXPECT_FALSE(survey.after.placement.given());
  EXPECT_TRUE(survey.fit.known);
  options.coregistration.mode = Alignment::off;
  options.difference.sigma = 0.5;
  const Survey given = survey_of(options);
  EXPECT_FALSE(given.fit.known);
  EXPECT_DOUBLE_EQ(given.errors.sigma(0.7), 0.5);
}

TEST_F(survey, states_no_error_where_the_later_model_was_made_from_the_earlier_one) {
  const Prepared prepared = prepare();
  EXPECT_FALSE(prepared.survey->errors.is_known());
  EXPECT_DOUBLE_EQ(prepared.survey->errors.same_share(), 1);
  EXPECT_TRUE(std::isnan(prepared.slide->volumes[0].volume.error));
  EXPECT_NEAR(prepared.slide->volumes[0].volume.volume, test::volume_of(bowl), 1e-6 * test::volume_of(bowl));
  std::vector<std::string> lines;
  const auto folder = scratch / "survey";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "difference_sigma.tif") << "of an earlier recipe";
  write_survey(folder, *prepared.survey, &prepared, {}, lines);
  EXPECT_FALSE(std::filesystem::exists(folder / "difference_sigma.tif")) << "no raster of zeros to score with";
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(folder / "survey.json"));
  EXPECT_EQ(json.at("error").at("known"), false);
  EXPECT_TRUE(json.at("source").at("error_m3").is_null());
  options.difference.sigma = 0.2;
  EXPECT_GT(prepare().slide->volumes[0].volume.error, 0) << "given, it is known";
}

/// A tenth of a millimetre is below what a survey tells, a centimetre is not.
TEST_F(survey, knows_the_error_of_two_surveys_however_good_they_are) {
  for (const double sigma : {1e-4, 0.01}) {
    const Scratch scratch;
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, sigma);
    samples::Sample valley = samples::valley(10);
    for (double& z : valley.rasters[1].second.values) z += noise(random);
    const Survey survey = survey_of(test::two_models(test::write(scratch, "before.tif", valley.rasters[0].second),
                                                     test::write(scratch, "after.tif", valley.rasters[1].second)));
    EXPECT_TRUE(survey.fit.known);
    EXPECT_EQ(survey.errors.is_known(), sigma > 1e-3) << sigma;
  }
}

TEST_F(survey, without_stable_ground_states_no_error_and_refuses_to_align) {
  const MapGrid small = grid_of(9, 9, 10);
  const auto plane = [](double x, double y) { return 0.3 * (x - 500000) + 0.1 * (y - 5100000); };
  rewrite_before(raster_of(small, plane));
  rewrite_after(raster_of(small, [&](double x, double y) { return plane(x, y) - 5; }));
  const Survey survey = survey_of(options);
  EXPECT_FALSE(survey.fit.known);
  EXPECT_FALSE(survey.errors.is_known());
  options.coregistration.mode = Alignment::apply;
  EXPECT_TRUE(holds(data_fault(), {"no stable ground"}));
}

/// They share a strip of eleven columns, but lie twelve apart.
TEST_F(survey, refuses_to_align_models_that_do_not_overlap_once_moved) {
  std::mt19937 random(4);
  const MapGrid grid = grid_of(120, 90, 10), later = grid_of(120, 90, 10, grid.east() - 110);
  const test::Hills hills(grid_of(240, 90, 10), random);
  rewrite_before(raster_of(grid, hills));
  rewrite_after(raster_of(later, [&](double x, double y) { return hills(x + 120, y); }));
  options.coregistration.mode = Alignment::apply;
  EXPECT_TRUE(holds(data_fault(), {"no stable ground"}));
}

TEST_F(survey, says_so_when_one_model_looks_like_feet) {
  Raster feet = after;
  for (double& z : feet.values) z /= 0.3048;
  rewrite_after(feet);
  EXPECT_TRUE(holds(data_fault(),
                    {"look like feet", "stretched to be drawn", "Declare it in after_dem: gdal_edit.py -units foot"}));
}

/// A unit of heights, and the name of it that a file declares.
struct Unit {
  double metres;
  const char* name;
};

/// Writes the heights of a scene in units that the files declare.
void rewrite_in(test::Scene& scene, const Unit& before, const Unit& after) {
  for (const auto& [file, raster, unit] : {std::tuple{scene.options.before_dem, scene.before, before},
                                           std::tuple{scene.options.after_dem, scene.after, after}}) {
    Raster in_units = raster;
    for (double& z : in_units.values) z /= unit.metres;
    write_geotiff(file, in_units, {"", unit.name, {}});
  }
}

TEST_F(survey, one_model_in_feet_and_one_in_metres_are_compared_in_metres) {
  constexpr double ft = 0.3048, us_ft = 1200.0 / 3937.0;
  struct Case {
    double before, after;
    const char *declared_before, *declared_after;
  };
  for (const Case& c : {Case{1, ft, "", "foot"}, {us_ft, 1, "us-survey-foot", ""}, {us_ft, ft, "us-ft", "ft"}}) {
    test::Scene scene;
    rewrite_in(scene, {c.before, c.declared_before}, {c.after, c.declared_after});
    const Prepared prepared = scene.prepare();
    const auto& difference = prepared.slide->change;
    for (std::size_t i = 0; i < difference.values.size(); ++i) {
      const double change = scene.after.values[i] - scene.before.values[i];
      if (!(scene.bowl.values[i] > 0)) continue;
      ASSERT_NEAR(difference.values[i], change, 1e-9);  // rounding of heights of 1000 m
    }
    EXPECT_NEAR(prepared.slide->volumes[0].volume.volume / test::volume_of(scene.bowl), 1, 1e-6);
    EXPECT_NEAR(prepared.total.volume / test::volume_of(scene.bowl), 1, 1e-6);
  }
}

/// Two cells: one beyond its level, one not.
TEST(difference, believes_what_lies_beyond_the_level_of_detection) {
  EXPECT_NEAR(std::erf(level_of_detection(0.5) / 0.5 / std::numbers::sqrt2), 0.95, 1e-12);
  EXPECT_EQ(level_of_detection(std::numeric_limits<double>::quiet_NaN()), 0) << "not known";
}

TEST(difference, budget_adds_up_with_errors_of_independent_cells) {
  const ErrorModel model = ErrorModel::of(0.3);
  BudgetSum sum;
  for (int i = 0; i < 100; ++i) sum.add(-2, 0.3);
  for (int i = 0; i < 25; ++i) sum.add(1, 0.3);
  const Budget budget = sum.budget(model, 10);
  EXPECT_DOUBLE_EQ(budget.erosion.volume, 20000);
  EXPECT_DOUBLE_EQ(budget.deposition.volume, 2500);
  EXPECT_DOUBLE_EQ(budget.net.volume, -17500);
  EXPECT_NEAR(budget.erosion.error, 0.3 * 100 * std::sqrt(100.0),
              1e-9);  // sigma times the cell's area times sqrt(cells)
  EXPECT_NEAR(budget.net.error, 0.3 * 100 * std::sqrt(125.0), 1e-9);
}

TEST(difference, is_the_same_by_blocks_of_any_grid) {
  std::mt19937 random(11);
  Elevation before, after;
  const MapGrid grid = grid_of(1100, 1050, 2);  // four blocks
  before.raster = raster_of(grid, test::Hills(grid, random));
  after.raster = raster_of(grid, test::Hills(grid, random));
  const ErrorModel model = ErrorModel::of(0.1);
  std::size_t cells = 0;
  double sum = 0;
  for_each_block(before, after, grid, model, [&](const Block& block) {
    cells += block.difference.values.size();
    for (const double d : block.difference.values) sum += d;
  });
  double whole = 0;
  for (std::size_t i = 0; i < grid.count(); ++i) whole += after.raster.values[i] - before.raster.values[i];
  EXPECT_EQ(cells, grid.count());
  EXPECT_NEAR(sum, whole, 1e-9 * std::abs(whole) + 1e-6);
}

/// White noise averaged over a window of known width has a variogram of that range.
TEST(variogram, finds_range_and_nugget_of_a_made_field) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const int size = 300, window = 12;
  std::vector<double> white((size + window) * (size + window));
  for (double& w : white) w = normal(random);
  Patch patch;
  patch.before = raster_of(grid_of(size, size, 5), [](double, double) { return 0.0; });
  std::vector<double> field(patch.before.values.size());
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      double sum = 0;
      for (int j = 0; j < window; ++j)
        for (int i = 0; i < window; ++i)
          sum += white[static_cast<std::size_t>((row + j) * (size + window) + column + i)];
      field[patch.before.grid.index(column, row)] = std::sqrt(0.7) * sum / window + std::sqrt(0.3) * normal(random);
    }
  const Variogram v = variogram_of({patch}, {field});
  EXPECT_NEAR(v.nugget, 0.3, 0.1);
  EXPECT_NEAR(v.correlation(window * 5 * 1.5), 0, 0.1);
  EXPECT_NEAR(v.correlation(window * 5 * 0.5), 0.7 * 0.25 * 1.5,
              0.15);  // (1 - h/w)^2 along the diagonal, 1 - h/w along a side
  const double area = 400.0 * 400.0;
  const double expected =
      0.7 * (window * 5.0) * (window * 5.0) / area + 0.3 * 25 / area;  // each side's window counts once
  EXPECT_NEAR(v.of_mean(area, 5) / expected, 1, 0.5);
  const double range = v.equivalent_range(area, 5);
  Variogram one{0, 1, range, 0, 0, {}, {}};
  EXPECT_NEAR(one.of_mean(area, 5) / v.of_mean(area, 5), 1, 0.01);
}

const char* const eastern_half =
    "POLYGON((500300 5100000, 500400 5100000, 500400 5100300, 500300 5100300, 500300 5100000))";

TEST(delineation, deposit_is_what_rose_beside_the_source_or_inside_its_polygon) {
  test::Scene scene;
  const double heap = test::volume_of(scene.heap);
  EXPECT_NEAR(scene.prepare().slide->volumes[1].volume.volume / heap, 1,
              0.02);  // rim thinner than threshold_m left out
  scene.options.deposit.polygon = test::write_polygon(scene.scratch, "heap.csv", eastern_half);
  const double part = scene.prepare().slide->volumes[1].volume.volume;
  EXPECT_GT(part, 0.3 * heap);
  EXPECT_LT(part, 0.7 * heap);  // the polygon begins at the heap's middle
}

/// What tells the alignment and what is delineated is the same outline: the file may be gone by then.
TEST(delineation, outlines_are_read_once_and_one_that_crosses_itself_is_refused_before_anything_is_compared) {
  test::Scene scene;
  scene.options.deposit.polygon = test::write_polygon(scene.scratch, "heap.csv", eastern_half);
  const Prepared whole = scene.prepare();
  const Survey survey = survey_of(scene.options);
  std::filesystem::remove(scene.scratch / "heap.csv");
  SurveyedSlide slide = slide_on(survey, scene.before, {});
  delineate(survey, {scene.before, scene.after, scene.bowl}, scene.options.deposit, slide);
  EXPECT_EQ(slide.volumes[1].volume.volume, whole.slide->volumes[1].volume.volume);
  EXPECT_GT(slide.volumes[1].volume.volume, 0);
  scene.options.deposit.polygon =
      test::write_polygon(scene.scratch, "heap.csv",
                          "POLYGON((500100 5100100, 500300 5100200, 500300 5100100, 500100 5100200, 500100 5100100))");
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { survey_of(scene.options); }),
                    {"heap.csv: polygon 1 is not valid (Self-intersection"}));
}

TEST(write_survey, leaves_rasters_outlines_and_styles_for_a_gis_and_outlines_of_the_same_slide) {
  test::Scene scene;
  const Prepared prepared = scene.prepare();
  std::vector<std::string> lines;
  const auto files = write_survey(scene.scratch / "survey", *prepared.survey, &prepared, {}, lines);
  for (const char* name :
       {"before_aligned.tif", "after_aligned.tif", "difference.tif", "stable_ground.tif", "source_thickness.tif",
        "sliding_surface.tif", "deposit_surveyed.tif", "slide_difference.tif", "outlines.gpkg", "survey.qgs",
        "survey.json", "difference.qml", "source_thickness.qml"})
    EXPECT_TRUE(std::filesystem::exists(scene.scratch / "survey" / name)) << name;
  const Raster difference = read_raster(scene.scratch / "survey" / "difference.tif");
  for (std::size_t i = 0; i < difference.values.size(); ++i)
    ASSERT_NEAR(difference.values[i], scene.after.values[i] - scene.before.values[i], 1e-4);
  EXPECT_NEAR(test::volume_of(read_raster(scene.scratch / "survey" / "source_thickness.tif")), prepared.total.volume,
              1e-6 * prepared.total.volume);
  EXPECT_EQ(read_polygons(scene.scratch / "survey" / "outlines.gpkg", "").front().name, "source");
  scene.options.source.polygon = scene.options.deposit.polygon = scene.scratch / "survey" / "outlines.gpkg";
  const Prepared again = scene.prepare();
  EXPECT_NEAR(again.total.volume / prepared.total.volume, 1, 0.02);
  EXPECT_NEAR(again.slide->volumes[1].volume.volume / prepared.slide->volumes[1].volume.volume, 1, 0.02);
}

}  // namespace
}  // namespace talus::preprocess
