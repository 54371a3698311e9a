// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>
#include <random>

#include "common/map/raster.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/member_analysis.hpp"
#include "postprocess/ensemble/results.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/scratch.hpp"

namespace talus::postprocess {
namespace {

using test::holds;

TEST(SamplingError, is_that_of_wilson_at_one_sigma_and_not_zero_where_no_member_came) {
  EXPECT_NEAR(standard_error(0.5, 40), 0.078, 0.001);  // sqrt(p q / n) = 0.079
  EXPECT_NEAR(standard_error(0.5, 1000), 0.0158, 0.0001);
  EXPECT_NEAR(standard_error(0.5, 10000), 0.005, 1e-5);
  EXPECT_NEAR(standard_error(0, 24), 0.5 / 25, 1e-12);
  EXPECT_EQ(standard_error(0, 24), standard_error(1, 24));
  // The interval's ends are the p with (share - p)^2 = p (1 - p) / n.
  for (const double n : {5.0, 24.0, 300.0})
    for (const double share : {0.0, 0.1, 0.5, 0.92, 1.0}) {
      const double middle = (share + 0.5 / n) / (1 + 1 / n), half = standard_error(share, n);
      for (const double p : {middle - half, middle + half})
        EXPECT_NEAR((share - p) * (share - p), p * (1 - p) / n, 1e-12) << "share " << share << " of " << n;
    }
}

TEST(SamplingError, holds_what_it_says_two_times_in_three) {
  std::mt19937_64 random(5);
  for (const double p : {0.1, 0.5, 0.8}) {
    std::binomial_distribution<int> draws(200, p);
    int inside = 0;
    for (int k = 0; k < 20000; ++k) {
      const double share = draws(random) / 200.0;
      const double middle = (share * 200 + 0.5) / 201;
      inside += std::abs(p - middle) <= standard_error(share, 200) ? 1 : 0;
    }
    EXPECT_NEAR(inside / 20000.0, 0.683, 0.04) << p;  // one whole number more at an end is up to 0.035
  }
}

TEST(MembersToHalve, halve_the_error) {
  for (const double n : {10.0, 100.0, 5000.0})
    for (const double share : {0.0, 0.01, 0.3, 0.5, 1.0}) {
      const double wanted = members_to_halve(share, n);
      EXPECT_NEAR(standard_error(share, wanted), 0.5 * standard_error(share, n), 1e-12) << share << " of " << n;
      EXPECT_GT(wanted, 1.9 * n);
      EXPECT_LT(wanted, 4.0 * n + 4);
    }
}

TEST(IndependentDraws, are_those_of_one_block_of_a_sensitivity_design) {
  MemberTable table;
  table.count = 600;
  EXPECT_EQ(independent_draws(table, 590), 590);
  table.sample_size = 100;
  EXPECT_EQ(independent_draws(table, 600), 100);
  EXPECT_EQ(independent_draws(table, 300), 50);
}

TEST(ShareWords, say_where_a_share_is_no_probability) {
  EXPECT_TRUE(holds(share_words("one-at-a-time").meaning, {"no probability"}));
  EXPECT_FALSE(is_probability("one-at-a-time"));
  EXPECT_TRUE(is_probability("sobol"));
}

/// Ishigami and Homma's function (1990), a = 7, b = 0.1, on [-pi, pi]^3.
double ishigami(const std::vector<double>& x) {
  return std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

/// A design of N (d + 2) members: the samples A and B, and for each key A with that key's values of B. The points are
/// Roberts' additive recurrence in six dimensions, which fills the cube more evenly than chance.
MemberTable sobol_design(std::size_t size, std::size_t keys) {
  double phi = 2;
  for (int n = 0; n < 50; ++n) phi = std::pow(1 + phi, 1.0 / (2 * static_cast<double>(keys) + 1));
  const auto draw = [&](std::size_t k, std::size_t column) {
    const double power = static_cast<double>(column + 1);
    const double u = std::fmod(0.5 + static_cast<double>(k + 1) * std::pow(1 / phi, power), 1.0);
    return std::numbers::pi * (2 * u - 1);
  };
  MemberTable table;
  table.design = "sensitivity";
  table.sample_size = static_cast<std::int64_t>(size);
  table.count = static_cast<std::int64_t>(size * (keys + 2));
  for (std::size_t key = 0; key < keys; ++key) {
    MemberColumn column{"x" + std::to_string(key + 1), {}, {}};
    for (std::size_t block = 0; block < keys + 2; ++block)
      for (std::size_t k = 0; k < size; ++k)
        column.values.push_back(draw(k, block == 1 || block == key + 2 ? keys + key : key));
    table.columns.push_back(column);
  }
  return table;
}

std::vector<double> results_of(const MemberTable& table, double (*function)(const std::vector<double>&)) {
  std::vector<double> results;
  for (std::size_t k = 0; k < static_cast<std::size_t>(table.count); ++k) {
    std::vector<double> x;
    for (const MemberColumn& column : table.columns) x.push_back(column.values[k]);
    results.push_back(function(x));
  }
  return results;
}

double index_of(const Sensitivity& found, const std::string& key, SensitivityMeasure measure) {
  for (const SensitivityIndex& index : found.indices)
    if (index.key == key && index.measure == measure) return index.value;
  ADD_FAILURE() << "no " << measure_words(measure).name << " of " << key;
  return nan;
}

TEST(Sensitivity, gives_the_sobol_indices_of_ishigamis_function) {
  const MemberTable table = sobol_design(4096, 3);
  const Sensitivity found = sensitivity(table, results_of(table, ishigami));
  const double first[] = {0.3139, 0.4424, 0.0}, total[] = {0.5576, 0.4424, 0.2437};
  for (int n = 0; n < 3; ++n) {
    const std::string key = "x" + std::to_string(n + 1);
    // Independent draws would scatter by about 0.02; these points are more even.
    EXPECT_NEAR(index_of(found, key, SensitivityMeasure::first_order), first[n], 0.02) << key;
    EXPECT_NEAR(index_of(found, key, SensitivityMeasure::total_order), total[n], 0.02) << key;
  }
  EXPECT_EQ(found.members, table.count);
  for (const SensitivityIndex& index : found.indices) {
    EXPECT_LT(index.low, index.value) << index.key;
    EXPECT_GT(index.high, index.value) << index.key;
    EXPECT_LT(index.high - index.low, 0.2) << index.key;
  }
}

TEST(Sensitivity, gives_the_same_numbers_again_and_leaves_out_rows_of_a_sobol_design_in_which_a_member_failed) {
  const MemberTable table = sobol_design(64, 3);
  const auto results = results_of(table, ishigami);
  const Sensitivity once = sensitivity(table, results), again = sensitivity(table, results);
  for (std::size_t n = 0; n < once.indices.size(); ++n) {
    EXPECT_EQ(once.indices[n].value, again.indices[n].value);
    EXPECT_EQ(once.indices[n].low, again.indices[n].low);
  }
  const MemberTable large = sobol_design(1024, 3);
  auto some = results_of(large, ishigami);
  for (std::size_t k = 5; k < some.size(); k += 97) some[k] = nan;
  const Sensitivity found = sensitivity(large, some);
  EXPECT_LT(found.members, large.count);
  EXPECT_TRUE(holds(found.note, {"of 1024 rows of the design are left out"}));
  EXPECT_NEAR(index_of(found, "x2", SensitivityMeasure::first_order), 0.4424, 0.08);
}

MemberTable drawn(std::int64_t members, const std::string& design) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  MemberTable table{design, 3, members, 0, {{"a", {}, {}}, {"b", {}, {}}, {"law", {}, {"one", "two", "three"}}},
                    {},     {}};
  for (std::int64_t k = 0; k < members; ++k) {
    table.columns[0].values.push_back(normal(random));
    table.columns[1].values.push_back(normal(random));
    table.columns[2].values.push_back(static_cast<double>(k % 3));
  }
  return table;
}

TEST(Sensitivity, gives_rank_correlations_that_do_not_care_for_the_scale) {
  const MemberTable table = drawn(2000, "latin-hypercube");
  const Sensitivity found =
      sensitivity(table, results_of(table, [](const std::vector<double>& x) { return std::exp(3 * x[0] - 4 * x[1]); }));
  // Of a sum of normal variables with weights .6 and -.8: Spearman's is 6 / pi asin(r / 2).
  EXPECT_NEAR(index_of(found, "a", SensitivityMeasure::spearman), 6 / std::numbers::pi * std::asin(0.3), 0.04);
  EXPECT_NEAR(index_of(found, "b", SensitivityMeasure::spearman), -6 / std::numbers::pi * std::asin(0.4), 0.04);
  EXPECT_NEAR(index_of(found, "a", SensitivityMeasure::srrc), 0.6, 0.06);
  EXPECT_NEAR(index_of(found, "b", SensitivityMeasure::srrc), -0.8, 0.06);
  EXPECT_TRUE(holds(found.note, {"no ranks: law"})) << "three words have no order";
  for (const SensitivityIndex& index : found.indices)
    if (index.measure == SensitivityMeasure::spearman) {
      const double width = 2 * 1.96 * std::sqrt(1.06 / 1997) * (1 - index.value * index.value);  // to first order
      EXPECT_NEAR(index.high - index.low, width, 0.01 * width);
      EXPECT_LT(index.low, index.value);
    }
}

TEST(Sensitivity, tells_by_hsic_what_ranks_cannot) {
  const MemberTable table = drawn(400, "sobol");
  const Sensitivity found =
      sensitivity(table, results_of(table, [](const std::vector<double>& x) { return std::exp(x[0] * x[0]); }));
  EXPECT_NEAR(index_of(found, "a", SensitivityMeasure::spearman), 0, 0.15) << "it falls and rises";
  EXPECT_GT(index_of(found, "a", SensitivityMeasure::hsic), 0.2);
  EXPECT_NEAR(index_of(found, "b", SensitivityMeasure::hsic), 0, 0.02);
  EXPECT_TRUE(holds(found.note, {"no effect is told (HSIC, p > 0.05) of b"})) << found.note;
  for (const std::size_t apart : {399u, 80u, 7u, 2u}) {
    std::vector<double> rare(400, 0.0);
    for (std::size_t k = 3; k < rare.size(); k += apart) rare[k] = 1;
    EXPECT_NO_THROW(sensitivity(table, rare)) << "members with one result, or few with another";
  }
  for (const std::int64_t few : {4, 5, 8, 20}) {
    const MemberTable small = drawn(few, "sobol");
    EXPECT_NO_THROW(sensitivity(small, small.columns[0].values)) << few;
  }
}

TEST(Sensitivity, says_why_there_is_none_and_gives_the_swing_of_keys_that_vary_alone) {
  const MemberTable table = drawn(10, "sobol");
  EXPECT_EQ(sensitivity(table, std::vector<double>(10, 3.0)).note, "the result is the same in all members");
  std::vector<double> failed(10, nan);
  failed[0] = 1;
  EXPECT_EQ(sensitivity(table, failed).note, "too few members");
  EXPECT_THROW(sensitivity(table, {1, 2}), std::logic_error);
  MemberTable alone{"one-at-a-time", 1, 5, 0, {{"a", {5, 1, 9, 5, 5}, {}}, {"b", {2, 2, 2, 0, 4}, {}}}, {}, {}};
  const Sensitivity found = sensitivity(alone, {10, 4, 20, 9, nan});
  EXPECT_EQ(index_of(found, "a", SensitivityMeasure::swing), 16);
  EXPECT_EQ(index_of(found, "b", SensitivityMeasure::swing), 1);
}

/// Members of the ensemble of tests as slides, each shifted on a large lattice.
struct ShiftedSlides {
  Ensemble ensemble;
  std::vector<RunMaps> runs;

  ShiftedSlides() {
    ensemble.table = test::ensemble_table(5, "slides");
    const EnsembleScene small = test::ensemble_scene();
    EnsembleScene large = small;
    large.grid = cut(small.grid, {0, 0, 3001, 2999});
    large.terrain.clear();
    large.before.clear();
    large.release_thickness.clear();
    large.tallied = Tallied::largest;
    ensemble.counts = empty_counts(large, 5, {0, 5}, {});
    for (std::int64_t k = 0; k < 5; ++k) {
      RunMaps maps = test::member_maps(small, test::reach_of(ensemble.table, k), test::depth_of(ensemble.table, k));
      maps.grid = cut(small.grid, {static_cast<int>(900 + 7 * k), static_cast<int>(2000 + 3 * k), 24, 16});
      ensemble.counts.add(k, maps, test::result_of(ensemble.table, k));
      runs.push_back(std::move(maps));
    }
  }

  EnsembleMap map(const std::string& name) const {
    for (const EnsembleMap& one : slide_maps(ensemble))
      if (one.name == name) return one;
    throw std::logic_error(name);
  }
  /// The largest of all slides in a cell of the lattice [m]; 0: none came.
  double largest_thickness(int column, int row) const {
    double largest = 0;
    for (const RunMaps& run : runs) {
      const CellWindow w = window_on(ensemble.counts.scene.grid, run.grid).value();
      const int c = column - w.column, r = row - w.row;
      if (c >= 0 && r >= 0 && c < w.columns && r < w.rows)
        largest = std::max(largest, run.peak_thickness[run.grid.index(c, r)]);
    }
    return largest;
  }
};

TEST(SlideMaps, hold_the_largest_of_all_slides_in_every_cell_and_are_no_probability) {
  const ShiftedSlides slides;
  const auto values = slide_values(slides.ensemble, slides.map("largest_peak_thickness"));
  std::size_t reached = 0;
  for (std::size_t place = 0; place < values.size(); ++place) {
    const auto [column, row] = slides.ensemble.counts.cells.cell(place);
    const double expected = slides.largest_thickness(column, row);
    if (expected == 0) {
      EXPECT_TRUE(std::isnan(values[place])) << "nobody came";
      continue;
    }
    EXPECT_NEAR(values[place], expected, 0.5e-3 + 1e-12) << "half a quantum";
    ++reached;
  }
  EXPECT_GT(reached, 300u);
  for (const EnsembleMap& map : slide_maps(slides.ensemble)) EXPECT_FALSE(holds(map.title, {"robability"}));
}

TEST(SlideMaps, made_coarse_keep_the_largest) {
  const ShiftedSlides slides;
  const EnsembleMap map = slides.map("largest_peak_thickness");
  const auto values = slide_values(slides.ensemble, map);
  const CellWindow part = reached_cells(slides.ensemble);
  const Raster coarse = coarse_map(slides.ensemble, map, values, part, 4);
  double fine = 0, found = 0;
  for (const double value : values) fine = std::fmax(fine, value);
  for (const double value : coarse.values) found = std::fmax(found, value);
  EXPECT_EQ(found, fine);
  EXPECT_LT(coarse.grid.columns, 40) << "the part in which slides came, not the lattice";
}

/// Overviews are counted from the north-west corner, whatever the number of rows.
TEST(SlideMaps, halved_keep_the_largest_of_four_counted_from_the_north_west) {
  const ShiftedSlides slides;
  const MapGrid& grid = slides.ensemble.counts.scene.grid;
  SparseValues fine{grid, KeptCells(grid), {}};
  const auto put = [&](int column, int line, double value) {
    const std::size_t place = fine.cells.keep(column, grid.rows - 1 - line);
    fine.values.resize(fine.cells.count(), nan);
    fine.values[place] = value;
  };
  put(0, 0, 2);
  put(1, 1, 5);
  put(2, 1, 3);
  put(3000, 2998, 4);
  MapGrid half = grid;
  half.cell = 20;
  half.columns = 1501;
  half.rows = 1500;
  half.south = grid.north() - 1500 * 20;
  const SparseValues coarse = halved(fine, half, false);
  const auto at = [&](int column, int line) { return coarse.values[coarse.cells.find(column, 1499 - line)]; };
  EXPECT_EQ(at(0, 0), 5);
  EXPECT_EQ(at(1, 0), 3);
  EXPECT_EQ(at(1500, 1499), 4);
  EXPECT_EQ(halved(fine, half, true).values[coarse.cells.find(0, 1499)], 2) << "of times the smallest";
}

}  // namespace
}  // namespace talus::postprocess
