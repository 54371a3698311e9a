// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/sand_laws.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::validation {
namespace {

TEST(sand_laws, give_the_column_of_the_reference_paper) {
  EXPECT_NEAR(0.09 * (1 + lube_run_out(7)), 0.8145, 1e-4);
  EXPECT_NEAR(0.09 * lube_height(7), 0.196, 1e-4);
  EXPECT_NEAR(0.09 * (1 + lajeunesse_run_out(7)), 0.716, 1e-3);
}

TEST(sand_laws, have_a_band_where_one_of_them_is_silent) {
  EXPECT_TRUE(std::isnan(lube_run_out(2)));
  const Band band = band_of(lube_run_out(2), lajeunesse_run_out(2));
  EXPECT_DOUBLE_EQ(band.low, 0.9 * 2.4);
  EXPECT_DOUBLE_EQ(band.high, 1.1 * 2.4);
}

TEST(sand_laws, band_holds_both_laws) {
  for (const double a : {0.5, 1.0, 1.5, 3.0, 5.0, 9.0}) {
    const Band band = band_of(lube_run_out(a), lajeunesse_run_out(a));
    EXPECT_LT(band.low, lajeunesse_run_out(a));
    EXPECT_GT(band.high, lube_run_out(a));
  }
}

}  // namespace
}  // namespace talus::validation
