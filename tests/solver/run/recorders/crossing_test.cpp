// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/crossing.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace talus::solver {
namespace {

using P = std::array<double, 2>;

TEST(Crossing, counts_from_left_to_right_of_the_line) {
  const P south{0, 0}, north{0, 10}, west{-1, 5}, east{1, 5};
  EXPECT_EQ(crossing(south, north, west, east), 1) << "who walks north has the west to his left";
  EXPECT_EQ(crossing(south, north, east, west), -1);
  EXPECT_EQ(crossing(north, south, west, east), -1);
  EXPECT_EQ(crossing(south, north, {-1, 11}, {1, 11}), 0) << "beside the line";
  EXPECT_EQ(crossing(south, north, {-2, 5}, {-1, 6}), 0) << "on one side";
}

TEST(Crossing, of_what_stops_on_the_line_counts_once) {
  const P south{0, 0}, north{0, 10};
  EXPECT_EQ(crossing(south, north, {-1, 5}, {0, 5}) + crossing(south, north, {0, 5}, {1, 5}), 1);
  EXPECT_EQ(crossing(south, north, {-1, 5}, {0, 5}) + crossing(south, north, {0, 5}, {-1, 5}), 0);
}

/// A line from one end of a square to the other parts it: whichever way a path takes, what it crosses is the change of
/// the side on which it is. Line and path have their corners on the same lattice, but for the shift of the line.
TEST(Crossing, of_a_line_that_parts_the_plane_is_the_change_of_side) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto number = [&](int most) { return static_cast<double>(random() % static_cast<unsigned>(most + 1)); };
    std::vector<P> line;
    for (int i = -1; i <= 11; ++i)  // rises: it never turns back
      line.push_back({number(4) + off_lattice[0], static_cast<double>(i) + off_lattice[1]});
    const auto is_left = [&](const P& p) {
      for (std::size_t i = 1; i < line.size(); ++i)
        if (p[1] >= line[i - 1][1] && p[1] < line[i][1]) return turn(line[i - 1], line[i], p) >= 0;
      return false;
    };
    P here{number(4), number(10)};
    const bool started_left = is_left(here);
    int net = 0;
    for (int step = 0; step < 50; ++step) {
      const P next{number(8) / 2, number(20) / 2};
      for (std::size_t i = 1; i < line.size(); ++i) net += crossing(line[i - 1], line[i], here, next);
      here = next;
    }
    EXPECT_EQ(net, static_cast<int>(started_left) - static_cast<int>(is_left(here)));
  }
}

TEST(Crossing, distance_is_to_the_piece_and_not_to_its_line) {
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {5, 3}), 3);
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {13, 4}), 5);
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {-3, 4}), 5);
}

}  // namespace
}  // namespace talus::solver
