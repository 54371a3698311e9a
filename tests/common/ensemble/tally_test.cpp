// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/tally.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace talus {
namespace {

/// Values of one cell over the members, log-normal from some centimetres to some tens of metres.
std::vector<double> draws(int count, unsigned seed, double share_absent = 0) {
  std::mt19937_64 random(seed);
  std::lognormal_distribution<double> thickness(0.3, 1.1);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> values;
  for (int k = 0; k < count; ++k) {
    const double value = thickness(random);
    values.push_back(uniform(random) < share_absent ? 0.0 : value);
  }
  return values;
}

MapTally tally_of(const CountedMap& map, const std::vector<double>& values, std::vector<double> thresholds) {
  MapTally tally(std::move(thresholds), 1);
  for (const double value : values) tally.add(map, std::vector<double>{value});
  return tally;
}

/// The smallest value that a share of the members does not exceed.
double exact_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1];
}

const CountedMap& thickness = counted_maps[0];
const CountedMap& arrival = counted_maps[4];

TEST(MapTally, counts_members_at_and_above_each_threshold) {
  const auto tally = tally_of(thickness, {0, 0.4999, 0.5, 0.7, nan, 3}, {0.5, 1});
  EXPECT_EQ(tally.exceeded[0][0], 3u) << "0.5 itself counts";
  EXPECT_EQ(tally.exceeded[1][0], 1u);
  EXPECT_EQ(tally.reached[0], 4u) << "0 and NaN say that nothing came";
}

TEST(MapTally, counts_arrivals_at_and_before_each_threshold) {
  const auto tally = tally_of(arrival, {0, 10, 10.01, nan}, {10, 60});
  EXPECT_EQ(tally.exceeded[0][0], 2u) << "0 s is a time, and 10 s is not later than 10 s";
  EXPECT_EQ(tally.exceeded[1][0], 3u);
  EXPECT_EQ(tally.reached[0], 3u);
}

TEST(MapTally, gives_mean_and_deviation_to_half_a_quantum) {
  const auto values = draws(500, 3, 0.2);
  const auto tally = tally_of(thickness, values, {1});
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 500;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  EXPECT_NEAR(tally.mean(thickness, 0, 500), mean, 0.5e-3);
  EXPECT_NEAR(tally.deviation(thickness, 0, 500), std::sqrt(squares / 500), 0.5e-3);
}

TEST(MapTally, takes_times_over_the_members_that_arrive) {
  const auto tally = tally_of(arrival, {10, 20, nan, nan}, {});
  EXPECT_NEAR(tally.mean(arrival, 0, 4), 15, 1e-9);
  EXPECT_NEAR(tally.deviation(arrival, 0, 4), 5, 1e-9);
  EXPECT_TRUE(std::isnan(tally_of(arrival, {nan}, {}).mean(arrival, 0, 1)));
}

TEST(MapTally, gives_quantiles_within_the_ratio_of_its_bins) {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const double absent : {0.0, 0.3}) {
      const auto values = draws(2000, seed, absent);
      const auto tally = tally_of(thickness, values, {1});
      for (const double share : {0.05, 0.35, 0.5, 0.95, 0.99}) {
        const double exact = exact_quantile(values, share), found = tally.quantile(thickness, 0, share, 2000);
        if (exact == 0) {
          EXPECT_EQ(found, 0) << "share " << share;
          continue;
        }
        EXPECT_LE(found, exact * thickness.ratio + 1e-3) << "share " << share << ", seed " << seed;
        EXPECT_GE(found, exact / thickness.ratio - 1e-3) << "share " << share << ", seed " << seed;
      }
    }
}

TEST(MapTally, has_no_quantile_of_a_time_that_too_few_members_reach) {
  const auto tally = tally_of(arrival, {10, 10, 10, nan}, {});
  EXPECT_NEAR(tally.quantile(arrival, 0, 0.5, 4), 10, 10 * (arrival.ratio - 1));
  EXPECT_TRUE(std::isnan(tally.quantile(arrival, 0, 0.9, 4))) << "a quarter never arrives";
}

TEST(MapTally, gives_the_same_bits_in_any_order_and_in_any_parts) {
  const auto values = draws(300, 9, 0.1);
  const MapTally whole = tally_of(thickness, values, {0.5, 2});
  std::mt19937_64 random(4);
  for (int round = 0; round < 5; ++round) {
    auto shuffled = values;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const auto cut = static_cast<std::ptrdiff_t>(random() % 300);
    MapTally first = tally_of(thickness, {shuffled.begin(), shuffled.begin() + cut}, {0.5, 2});
    first.add(thickness, tally_of(thickness, {shuffled.begin() + cut, shuffled.end()}, {0.5, 2}));
    EXPECT_EQ(first.exceeded, whole.exceeded);
    EXPECT_EQ(first.extreme, whole.extreme);
    EXPECT_EQ(first.sum, whole.sum);
    EXPECT_EQ(first.sum_of_squares, whole.sum_of_squares);
    const auto ours = first.histograms.of(0), theirs = whole.histograms.of(0);
    EXPECT_TRUE(std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end()));
  }
}

TEST(MapTally, does_not_overflow_with_a_million_members_of_the_largest_value) {
  MapTally tally({1}, 1), million({1}, 1);
  for (int k = 0; k < 1000; ++k) tally.add(thickness, std::vector<double>{1e9});
  for (int k = 0; k < 1000; ++k) million.add(thickness, tally);
  EXPECT_EQ(million.reached[0], 1'000'000u);
  EXPECT_NEAR(million.mean(thickness, 0, 1'000'000), 3000, 1e-9) << "the largest that is counted";
  EXPECT_NEAR(million.deviation(thickness, 0, 1'000'000), 0, 1e-3);
}

TEST(MapTally, refuses_counts_of_another_grid_or_of_other_thresholds) {
  MapTally tally({1}, 2);
  EXPECT_THROW(tally.add(thickness, MapTally({1}, 3)), std::logic_error);
  EXPECT_THROW(tally.add(thickness, MapTally({2}, 2)), std::logic_error);
  EXPECT_THROW(tally.add(thickness, std::vector<double>{1}), std::logic_error);
}

TEST(MapTally, keeps_the_largest_value_and_of_a_time_the_smallest) {
  const auto tally = tally_of(thickness, {0.4, 3.0004, 0, nan, 2}, {});
  EXPECT_NEAR(tally.largest(thickness, 0), 3.0004, 0.5e-3) << "to half a quantum";
  EXPECT_NEAR(tally_of(arrival, {nan, 12, 7.5, 60}, {}).largest(arrival, 0), 7.5, 0.5e-2);
  EXPECT_EQ(tally_of(thickness, {0, nan}, {}).largest(thickness, 0), 0) << "nobody came";
  EXPECT_TRUE(std::isnan(tally_of(arrival, {nan}, {}).largest(arrival, 0)));
}

TEST(MapTally, of_different_things_keeps_no_distribution_and_the_same_counts) {
  const auto values = draws(200, 5, 0.3);
  const MapTally whole = tally_of(thickness, values, {0.5, 2});
  MapTally bare({0.5, 2}, 1, Tallied::largest);
  for (const double value : values) bare.add(thickness, std::vector<double>{value});
  EXPECT_EQ(bare.exceeded, whole.exceeded);
  EXPECT_EQ(bare.reached, whole.reached);
  EXPECT_EQ(bare.extreme, whole.extreme);
  EXPECT_TRUE(bare.sum.empty());
  EXPECT_THROW(bare.add(thickness, whole), std::logic_error) << "they cannot be added up";
}

TEST(BinEdges, grow_for_every_map_and_reach_what_flows_do) {
  for (const CountedMap& map : counted_maps) {
    const auto edges = bin_edges(map);
    EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end(), std::less_equal<>())) << map.name;
    const double last = map.quantum * static_cast<double>(edges.back());
    EXPECT_GT(last, std::string(map.unit) == "m" ? 200 : std::string(map.unit) == "m s-1" ? 300 : 2000) << map.name;
  }
}

}  // namespace
}  // namespace talus
