// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Coarse functions as sums of fine ones (T20): both ways of reading the weights agree, and constants are kept.
#include "solver/linear/preconditioner/two_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::solver {
namespace {

class TwoScales : public ::testing::TestWithParam<TwoScale::Kind> {
 protected:
  TwoScale scale() const { return {GetParam()}; }
};

TEST_P(TwoScales, fine_functions_have_weights_that_add_up_to_one) {
  for (int fine = 0; fine < 40; ++fine) {
    int coarse[2];
    double weights[2], sum = 0;
    const int parents = scale().parents(fine, coarse, weights);
    for (int n = 0; n < parents; ++n) sum += weights[n];
    EXPECT_DOUBLE_EQ(sum, 1);
  }
}

TEST_P(TwoScales, children_and_parents_tell_the_same_weights) {
  constexpr int count = 31;
  for (int coarse = 0; coarse < scale().count(count); ++coarse) {
    for (int n = 0; n < scale().children(); ++n) {
      const int fine = scale().first(coarse) + n;
      if (fine < 0 || fine >= count) continue;
      int of[2];
      double weights[2], found = 0;
      const int parents = scale().parents(fine, of, weights);
      for (int p = 0; p < parents; ++p) {
        if (of[p] == coarse) found += weights[p];
      }
      EXPECT_DOUBLE_EQ(found, scale().weight(n)) << "coarse " << coarse << ", fine " << fine;
    }
  }
}

TEST_P(TwoScales, every_parent_is_among_the_coarse_functions) {
  for (int count = 1; count < 20; ++count) {
    for (int fine = 0; fine < count; ++fine) {
      int coarse[2];
      double weights[2];
      const int parents = scale().parents(fine, coarse, weights);
      for (int p = 0; p < parents; ++p) {
        EXPECT_GE(coarse[p], 0);
        EXPECT_LT(coarse[p], scale().count(count));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(kinds, TwoScales, ::testing::Values(TwoScale::same, TwoScale::hats, TwoScale::splines),
                         [](const auto& kind) {
                           return kind.param == TwoScale::same   ? "same"
                                  : kind.param == TwoScale::hats ? "hats"
                                                                 : "splines";
                         });

double hat(double x) { return std::max(0.0, 1 - std::abs(x)); }

// A hat of twice the spacing is the sum that (T20) says.
TEST(two_scale, coarse_hat_is_the_sum_of_fine_hats) {
  const TwoScale scale{TwoScale::hats};
  for (int tenths = -25; tenths <= 25; ++tenths) {
    const double x = 0.1 * tenths;
    double sum = 0;
    for (int n = 0; n < 3; ++n) sum += scale.weight(n) * hat(x - (n - 1));
    EXPECT_NEAR(sum, hat(x / 2), 1e-15);
  }
}

}  // namespace
}  // namespace talus::solver
