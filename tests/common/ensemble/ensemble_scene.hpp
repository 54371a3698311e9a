// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up ensemble: a slope of 24 x 16 cells, down which the members' flows reach as far as their numbers say.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"

namespace talus::test {

inline EnsembleScene ensemble_scene() {
  EnsembleScene scene;
  scene.scene = "slope";
  scene.title = "Made-up slope";
  scene.grid = {.columns = 24, .rows = 16, .west = 600000, .south = 5100000, .cell = 10, .crs_wkt = ""};
  for (int row = 0; row < scene.grid.rows; ++row)
    for (int column = 0; column < scene.grid.columns; ++column) {
      const bool released = column >= 2 && column < 5 && row >= 5 && row < 11;
      scene.terrain.push_back(row == 0 ? nan : 500 - 6.0 * column + std::abs(row - 7.5));
      scene.release_thickness.push_back(released ? 3.0 : 0.0);
      scene.before.push_back(scene.terrain.back() + scene.release_thickness.back());
    }
  scene.threshold = 0.1;
  return scene;
}

/// The maps of a member whose flow reaches column `reach` and is `depth` thick [m].
inline RunMaps member_maps(const EnsembleScene& scene, int reach, double depth) {
  RunMaps maps;
  maps.grid = scene.grid;
  maps.threshold = scene.threshold;
  const std::size_t cells = scene.grid.count();
  for (auto field :
       {&RunMaps::peak_thickness, &RunMaps::deposit_thickness, &RunMaps::peak_speed, &RunMaps::peak_pressure_kPa})
    (maps.*field).assign(cells, 0.0);
  maps.arrival_time.assign(cells, nan);
  maps.initial_thickness = scene.release_thickness;
  for (int row = 4; row < 12; ++row)
    for (int column = 2; column < reach; ++column) {
      const std::size_t cell = scene.grid.index(column, row);
      const double across = 1 - std::abs(row - 7.5) / 8;
      maps.peak_thickness[cell] = depth * across * (1 + 0.02 * column);
      maps.deposit_thickness[cell] = column > reach - 6 ? 0.7 * depth * across : 0;
      maps.peak_speed[cell] = 4 * depth * across;
      maps.peak_pressure_kPa[cell] = 2.0 * std::pow(maps.peak_speed[cell], 2);
      maps.arrival_time[cell] = 1.3 * (column - 2) / depth;
    }
  return maps;
}

/// Friction [degrees] and factor of thickness of the members, drawn from a seed; two laws in turn.
inline MemberTable ensemble_table(std::int64_t members, const std::string& design = "monte-carlo") {
  std::mt19937_64 random(7);
  MemberTable table;
  table.design = design;
  table.seed = 7;
  table.count = members;
  table.columns = {{"solve.base.friction_angle_deg", {}, {}},
                   {"preprocess.thickness_factor", {}, {}},
                   {"solve.base.law", {}, {"coulomb", "voellmy"}}};
  for (std::int64_t k = 0; k < members; ++k) {
    const auto draw = [&] { return static_cast<double>(random() % 10000) / 10000; };
    table.columns[0].values.push_back(14 + 12 * draw());
    table.columns[1].values.push_back(0.6 + 0.9 * draw());
    table.columns[2].values.push_back(static_cast<double>(k % 2));
  }
  table.own_domain.assign(static_cast<std::size_t>(members), 0);
  return table;
}

/// The cells that a member of that table reaches, and its thickness.
inline int reach_of(const MemberTable& table, std::int64_t member) {
  const auto k = static_cast<std::size_t>(member);
  return 6 + static_cast<int>(std::lround((26 - table.columns[0].values[k]) + 4 * (table.columns[1].values[k] - 0.6)));
}
inline double depth_of(const MemberTable& table, std::int64_t member) {
  return 2 * table.columns[1].values[static_cast<std::size_t>(member)];
}

inline MemberResult result_of(const MemberTable& table, std::int64_t member) {
  const double reach = reach_of(table, member), depth = depth_of(table, member);
  MemberResult result;
  result.run_out = 10 * (reach - 2);
  result.flow_reach = result.run_out;
  result.drop = 6 * (reach - 2);
  result.reach_ratio = 0.6;
  result.flow_area = 800 * (reach - 2);
  result.deposit_area = 800 * 5;
  result.volume_released = 5400 * depth / 2;
  result.volume_final = result.volume_released;
  result.volume_outflow = 0;
  result.largest_thickness = depth * 1.3;
  result.p99_thickness = 0.9 * result.largest_thickness;
  result.largest_deposit = depth * 0.7;
  result.p99_deposit = 0.9 * result.largest_deposit;
  result.largest_speed = 4 * depth;
  result.p99_speed = 0.9 * result.largest_speed;
  result.largest_pressure = 2 * std::pow(4 * depth, 2);
  result.p99_pressure = 0.9 * result.largest_pressure;
  result.time_end = 60;
  result.steps = 400 + static_cast<double>(member);
  result.wall_time = 0.2;
  result.at_gauges = {{"gauge_bridge_arrival_s", reach > 12 ? 20 - reach / 2 : nan}};
  return result;
}

/// The counts of a part of that ensemble. Every `fails`-th member fails; 0: none.
inline EnsembleCounts part_of_ensemble(const MemberTable& table, const MemberRange& part, std::int64_t fails = 0) {
  ThresholdOptions thresholds;
  thresholds.arrival = {5, 10};
  EnsembleCounts counts = empty_counts(ensemble_scene(), table.count, part, thresholds);
  counts.fingerprint = "0123456789abcdef";
  for (std::int64_t k = part.first; k < part.end; ++k)
    if (fails > 0 && k % fails == fails - 1)
      counts.fail(k, "the step has fallen below 1e-9 s, \"far\" too short");
    else
      counts.add(k, member_maps(counts.scene, reach_of(table, k), depth_of(table, k)), result_of(table, k));
  return counts;
}

inline void expect_same_blocks(const KeptCells& a, const KeptCells& b) {
  std::vector<std::int32_t> ours = a.blocks(), theirs = b.blocks();
  std::sort(ours.begin(), ours.end());
  std::sort(theirs.begin(), theirs.end());
  EXPECT_EQ(ours, theirs);
}

inline std::vector<std::uint32_t> histogram_of(const EnsembleCounts& counts, std::size_t map, int column, int row) {
  const std::size_t place = counts.cells.find(column, row);
  if (place == KeptCells::none || counts.maps[map].histograms.of(place).empty()) return {};
  const auto bins = counts.maps[map].histograms.of(place);
  return {bins.begin(), bins.end()};
}

/// Cells, counts, sums and histograms, bit for bit.
inline void expect_same_maps(const EnsembleCounts& a, const EnsembleCounts& b) {
  expect_same_blocks(a.cells, b.cells);
  for (std::size_t m = 0; m < a.maps.size(); ++m) {
    SCOPED_TRACE(counted_maps[m].name);
    const MapTally &ours = a.maps[m], &theirs = b.maps[m];
    EXPECT_EQ(ours.thresholds, theirs.thresholds);
    for (std::size_t n = 0; n < ours.exceeded.size(); ++n)
      EXPECT_EQ(a.cells.spread(ours.exceeded[n], 0u), b.cells.spread(theirs.exceeded[n], 0u));
    EXPECT_EQ(a.cells.spread(ours.reached, 0u), b.cells.spread(theirs.reached, 0u));
    EXPECT_EQ(a.cells.spread(ours.extreme, -1), b.cells.spread(theirs.extreme, -1));
    EXPECT_EQ(a.cells.spread(ours.sum, std::int64_t{0}), b.cells.spread(theirs.sum, std::int64_t{0}));
    EXPECT_EQ(a.cells.spread(ours.sum_of_squares, std::int64_t{0}),
              b.cells.spread(theirs.sum_of_squares, std::int64_t{0}));
    for (int row = 0; row < a.scene.grid.rows; ++row)
      for (int column = 0; column < a.scene.grid.columns; ++column)
        EXPECT_EQ(histogram_of(a, m, column, row), histogram_of(b, m, column, row)) << column << ", " << row;
  }
}

}  // namespace talus::test
