// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The blocks of nodes: whether they can be inverted, and what takes their place.
#include "solver/linear/preconditioner/preconditioner.hpp"

#include <gtest/gtest.h>

namespace talus::solver {
namespace {

TEST(node_blocks, definite_blocks_are_told_from_others) {
  EXPECT_TRUE(is_definite({2, 2, 2, 1, 0, 0}));
  EXPECT_FALSE(is_definite({2, 2, 2, 2, 0, 0}));   // singular
  EXPECT_FALSE(is_definite({2, -2, 2, 0, 0, 0}));  // indefinite
}

TEST(node_blocks, diagonal_that_can_be_inverted_stands_in_for_a_block_that_cannot) {
  const Sym3<double> safe = diagonal_of({-3, 0, 2, 5, 5, 5});
  EXPECT_EQ(safe.xx, 3);
  EXPECT_EQ(safe.yy, 1);
  EXPECT_EQ(safe.zz, 2);
  EXPECT_EQ(safe.xy, 0);
}

}  // namespace
}  // namespace talus::solver
