// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/sampling_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace talus::postprocess {
namespace {

TEST(SamplingError, of_one_half_is_that_of_a_binomial_share) {
  EXPECT_NEAR(standard_error(0.5, 40), 0.078, 0.001);  // sqrt(p q / n) = 0.079
  EXPECT_NEAR(standard_error(0.5, 1000), 0.0158, 0.0001);
  EXPECT_NEAR(standard_error(0.5, 10000), 0.005, 1e-5);
}

TEST(SamplingError, is_that_of_wilson_at_one_sigma) {
  // The interval's ends are the p with (share - p)^2 = p (1 - p) / n.
  for (const double n : {5.0, 24.0, 300.0})
    for (const double share : {0.0, 0.1, 0.5, 0.92, 1.0}) {
      const double middle = (share + 0.5 / n) / (1 + 1 / n), half = standard_error(share, n);
      for (const double p : {middle - half, middle + half})
        EXPECT_NEAR((share - p) * (share - p), p * (1 - p) / n, 1e-12) << "share " << share << " of " << n;
    }
}

TEST(SamplingError, is_not_zero_where_no_member_came) {
  EXPECT_NEAR(standard_error(0, 24), 0.5 / 25, 1e-12);
  EXPECT_EQ(standard_error(0, 24), standard_error(1, 24));
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
  EXPECT_NE(share_words("one-at-a-time").meaning.find("no probability"), std::string::npos);
  EXPECT_FALSE(is_probability("one-at-a-time"));
  EXPECT_TRUE(is_probability("sobol"));
}

}  // namespace
}  // namespace talus::postprocess
