// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What laws without plastic flow have in common.
#include "solver/material/laws/elastic.hpp"

#include <gtest/gtest.h>

#include "solver/material/laws/corotated.hpp"

namespace talus {
namespace {

TEST(ElasticLaws, keep_the_trial_and_nothing_plastic) {
  MaterialState<double> state{{0.01, -0.02, 0.03, 0.004, 0.005, 0.006}, 0.02, 0};
  const Increment<double> step(Mat3<double>{}, 0.1, MeanVolume<double>{});
  ElasticLaw<Corotated>::settle<double>({}, {}, step, state);
  EXPECT_EQ(state.elastic.yy, -0.02);
  EXPECT_EQ(state.elastic.xz, 0.006);
  EXPECT_EQ(state.plastic_log_volume, 0);
  EXPECT_EQ(state.plastic_shear, 0);
}

TEST(ElasticLaws, go_on_with_all_of_the_strain_of_gravity_loading) {
  const Sym3<double> loaded{-3, -3, -6, 1, 2, 3};
  const Sym3<double> kept = ElasticLaw<Corotated>::after_loading(loaded);
  EXPECT_EQ(kept.zz, loaded.zz);
  EXPECT_EQ(kept.yz, loaded.yz);
}

TEST(ElasticLaws, neither_soften_nor_dilate) {
  EXPECT_FALSE(ElasticLaw<Corotated>::Options{}.softens());
  EXPECT_FALSE(ElasticLaw<Corotated>::Options{}.dilates());
}

}  // namespace
}  // namespace talus
