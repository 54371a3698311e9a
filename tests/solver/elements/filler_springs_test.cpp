// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The springs (T17a) that hold nearly empty nodes in statics: which nodes they take, and what they do not feel.
#include "solver/elements/filler_springs.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace talus::solver::testing {
namespace {

/// An element of quadratic functions whose nodes grow heavier along x.
struct QuadraticElement {
  std::vector<int> nodes = std::vector<int>(27);
  std::vector<double> mass = std::vector<double>(27);
  QuadraticElement() {
    std::iota(nodes.begin(), nodes.end(), 0);
    for (int n = 0; n < 27; ++n) mass[static_cast<std::size_t>(n)] = n / 3 % 3 == 0 ? 0.01 : n / 3 % 3;
  }
  FillerSprings springs() const { return {.mass = mass.data(), .light = 0.1, .stiffness = 100}; }
};

TEST(FillerSprings, hold_light_nodes_to_a_line_inwards) {
  const QuadraticElement e;
  const FillerSpring s = e.springs().at<3>(e.nodes.data(), 1);  // on the light side
  EXPECT_DOUBLE_EQ(s.k, 100 * (1 - 0.01 / 0.1));
  EXPECT_EQ(s.node, 1);
  EXPECT_EQ(s.near, 4);
  EXPECT_EQ(s.far, 7);
  EXPECT_EQ(s.lead, 1);
}

TEST(FillerSprings, feel_no_affine_motion) {
  const QuadraticElement e;
  const FillerSpring s = e.springs().at<3>(e.nodes.data(), 0);
  ASSERT_GT(s.k, 0);
  double constant = 0, linear = 0;
  for (int a = 0; a < 3; ++a) {
    constant += s.share(a);
    linear += s.share(a) * (s.local(a) / 3 % 3);
  }
  EXPECT_EQ(constant, 0);
  EXPECT_EQ(linear, 0);
}

TEST(FillerSprings, leave_full_and_empty_nodes_alone) {
  QuadraticElement e;
  EXPECT_EQ(e.springs().at<3>(e.nodes.data(), 4).k, 0);
  e.mass[0] = 0;
  EXPECT_EQ(e.springs().at<3>(e.nodes.data(), 0).k, 0);
  EXPECT_FALSE(FillerSprings{}.on());
}

TEST(FillerSprings, hold_hats_to_the_fullest_node_more_weakly) {
  const std::vector<int> nodes{0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<double> mass{0.05, 1, 1, 1, 1, 3, 1, 1};
  const FillerSprings springs{.mass = mass.data(), .light = 0.1, .stiffness = 100};
  const FillerSpring s = springs.at<2>(nodes.data(), 0);
  EXPECT_DOUBLE_EQ(s.k, 0.5);
  EXPECT_EQ(s.near, 5);
  EXPECT_EQ(s.share(0) + s.share(1), 0);
  EXPECT_EQ(s.share(2), 0);
}

}  // namespace
}  // namespace talus::solver::testing
