// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/slide_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/map/crop.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"

namespace talus::postprocess {
namespace {

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

TEST(SlideMaps, hold_the_largest_of_all_slides_in_every_cell) {
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
}

TEST(SlideMaps, call_nothing_a_probability) {
  const ShiftedSlides slides;
  for (const EnsembleMap& map : slide_maps(slides.ensemble))
    EXPECT_EQ(map.title.find("robability"), std::string::npos) << map.title;
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
