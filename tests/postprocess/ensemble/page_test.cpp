// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of an ensemble is made of; the page itself is used in a browser by tests/pipeline.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "postprocess/ensemble/convergence.hpp"
#include "postprocess/ensemble/medoids.hpp"
#include "postprocess/ensemble/page.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"

namespace talus::postprocess {
namespace {

TEST(Convergence, ends_on_mean_and_standard_error_of_all) {
  const Convergence steps = convergence({3, nan, 5, 7, 1}, 10);
  EXPECT_EQ(steps.members, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(steps.mean.front(), 3);
  EXPECT_TRUE(std::isnan(steps.error.front())) << "of one member";
  EXPECT_DOUBLE_EQ(steps.mean.back(), 4);
  EXPECT_DOUBLE_EQ(steps.error.back(), std::sqrt(20.0 / 3 / 4));
}

TEST(Convergence, has_no_more_steps_than_asked_for_and_the_last_is_of_all) {
  std::vector<double> values(1000);
  std::iota(values.begin(), values.end(), 0);
  const Convergence steps = convergence(values, 64);
  EXPECT_EQ(steps.members.size(), 64u);
  EXPECT_EQ(steps.members.back(), 1000);
  EXPECT_TRUE(convergence({nan, nan}, 10).members.empty());
}

/// Twice the signed area of a closed line, in half cells squared.
int area_of(const std::vector<int>& line) {
  int sum = 0;
  for (std::size_t n = 0; n + 3 < line.size(); n += 2) sum += line[n] * line[n + 3] - line[n + 2] * line[n + 1];
  return sum;
}

TEST(FootprintOutlines, are_closed_and_hold_corners_alone) {
  const MapGrid grid{.columns = 6, .rows = 5, .west = 1000, .south = 2000, .cell = 10, .crs_wkt = ""};
  std::vector<std::uint8_t> cells(grid.count(), 0);
  for (int row = 1; row < 4; ++row)
    for (int column = 1; column < 5; ++column) cells[grid.index(column, row)] = 1;
  const auto lines = footprint_outlines(cells, grid);
  ASSERT_EQ(lines.size(), 1u);
  const auto& line = lines[0];
  EXPECT_EQ(line[0], line[line.size() - 2]);
  EXPECT_EQ(line[1], line[line.size() - 1]);
  EXPECT_LE(line.size(), 2 * 10u) << "8 corners of a rectangle without its tips, the first twice, and where it begins";
  // 4 x 3 cells are 48 quarter cells; marching squares cuts an eighth of a cell off each of the four corners.
  EXPECT_EQ(std::abs(area_of(line)), 2 * (48 - 2));
}

TEST(FootprintOutlines, end_at_the_edge_of_the_grid) {
  const MapGrid grid{.columns = 3, .rows = 2, .west = 0, .south = 0, .cell = 5, .crs_wkt = ""};
  const auto lines = footprint_outlines(std::vector<std::uint8_t>(6, 1), grid);
  ASSERT_EQ(lines.size(), 1u);
  for (std::size_t n = 0; n < lines[0].size(); n += 2) {
    EXPECT_GE(lines[0][n], 0);
    EXPECT_LE(lines[0][n], 6);
    EXPECT_GE(lines[0][n + 1], 0);
    EXPECT_LE(lines[0][n + 1], 4);
  }
}

TEST(JaccardDistance, is_one_less_the_common_share) {
  EXPECT_EQ(jaccard_distance({2, 3, 5}, {2, 3, 5}), 0);
  EXPECT_EQ(jaccard_distance({0, 4, 6}, {2, 4, 4}), 1 - 2.0 / 6);
  EXPECT_EQ(jaccard_distance({0, 4, 6}, {4, 6}), 1);
  EXPECT_EQ(jaccard_distance({10}, {10}), 0) << "both came nowhere";
}

TEST(JaccardDistance, is_that_of_the_cells_for_any_footprints) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> a(60), b(60);
    for (double& v : a) v = static_cast<double>(random() % 2);
    for (double& v : b) v = static_cast<double>(random() % 2);
    double common = 0, either = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      common += a[n] > 0 && b[n] > 0 ? 1 : 0;
      either += a[n] > 0 || b[n] > 0 ? 1 : 0;
    }
    EXPECT_DOUBLE_EQ(jaccard_distance(footprint_of(a, 0.5), footprint_of(b, 0.5)), 1 - common / either);
  }
}

TEST(Medoids, find_the_groups_that_are_there) {
  EnsembleCounts counts;
  const auto add = [&](const Footprint& footprint, MemberState state = MemberState::counted) {
    counts.states.push_back(state);
    counts.flow.push_back(footprint);
  };
  for (const std::int32_t reach : {10, 11, 12}) add({0, reach, 40 - reach});  // three that stay near
  add({}, MemberState::failed);
  for (const std::int32_t reach : {29, 30, 31, 30}) add({0, reach, 40 - reach});  // four that go far
  const Medoids found = medoids(counts, 2, 100);
  EXPECT_EQ(found.members, (std::vector<std::int64_t>{5, 1})) << "the middle of each group, the larger first";
  EXPECT_EQ(found.counts, (std::vector<std::int64_t>{4, 3}));
  EXPECT_EQ(found.represented_by, (std::vector<std::int64_t>{1, 1, 1, -1, 5, 5, 5, 5}));
}

TEST(Medoids, are_no_more_than_footprints_differ) {
  EnsembleCounts counts;
  counts.states.assign(5, MemberState::counted);
  counts.flow.assign(5, {0, 7, 3});
  EXPECT_EQ(medoids(counts, 3, 100).members.size(), 1u);
  EXPECT_EQ(medoids(counts, 3, 100).counts[0], 5);
}

}  // namespace
}  // namespace talus::postprocess
