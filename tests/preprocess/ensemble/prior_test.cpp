// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// `prior` of [ensemble]: friction that another event taught, or that is usual for a class of events.
#include "preprocess/ensemble/prior.hpp"

#include <cmath>

#include <fmt/format.h>

#include "common/ensemble/openturns.hpp"
#include "preprocess/ensemble/marginal.hpp"
#include "tests/preprocess/ensemble/drawing.hpp"

namespace talus::preprocess {
namespace {

class Prior : public ::testing::Test {
 protected:
  EnsembleOptions expanded(const std::string& prior, const std::string& base, const std::string& more = {}) {
    const recipe::Recipe recipe(scratch_.write(
        "recipe.toml", "[solve.base]\n" + base + "[ensemble]\nmembers = 512\nprior = \"" + prior + "\"\n" + more));
    return with_prior(ensemble_of(recipe), recipe);
  }
  std::string refusal(const std::string& prior, const std::string& base) {
    return test::fault_of<RecipeError>([&] { expanded(prior, base); });
  }
  test::Scratch scratch_;
};

TEST_F(Prior, of_a_class_has_the_mean_and_deviation_of_its_table) {
  const EnsembleOptions o = expanded("snow-avalanche", "law = \"voellmy\"\nturbulence_m_s2 = 1500\n");
  ASSERT_EQ(o.vary.size(), 2u);
  EXPECT_EQ(o.vary[0].key, "solve.base.friction_coefficient");
  EXPECT_NEAR(Marginal(o.vary[0]).mean(), 0.23, 0.001);
  EXPECT_NEAR(Marginal(o.vary[0]).deviation(), 0.06, 0.002);
  EXPECT_NEAR(Marginal(o.vary[1]).quantile(0.5), 2000 / std::sqrt(1 + 0.35 * 0.35), 5) << "mean / sqrt(1 + cv^2)";
  EXPECT_TRUE(test::holds(o.prior_source, {"snow-avalanche"}));
}

TEST_F(Prior, of_a_class_varies_the_angle_where_the_recipe_gives_one) {
  const EnsembleOptions o = expanded("rock-avalanche", "law = \"coulomb\"\nfriction_angle_deg = 17\n");
  ASSERT_EQ(o.vary.size(), 1u);
  EXPECT_EQ(o.vary[0].key, "solve.base.friction_angle_deg");
  const double median = 0.3 / std::sqrt(1 + 1.0 / 9);  // of the coefficient
  EXPECT_NEAR(std::tan(Marginal(o.vary[0]).quantile(0.5) * 3.14159265358979 / 180), median, 1e-4);
}

TEST_F(Prior, of_a_class_refuses_a_law_that_it_has_no_friction_for) {
  EXPECT_TRUE(test::holds(refusal("debris-flow", "law = \"coulomb\"\nfriction_angle_deg = 17\n"),
                          {"\"debris-flow\" with [solve.base] law = \"coulomb\"", "no friction of this class"}));
  EXPECT_TRUE(test::holds(refusal("debris-flow", ""), {"law = none"}));
}

TEST_F(Prior, gives_way_to_the_recipes_own_distributions) {
  const EnsembleOptions o = expanded("debris-flow", "law = \"voellmy\"\n",
                                     "[[ensemble.vary]]\nkey = \"solve.base.friction_coefficient\"\nlow = 0.1\n"
                                     "high = 0.2\n");
  ASSERT_EQ(o.vary.size(), 2u);
  EXPECT_EQ(o.vary[0].distribution, Distribution::uniform);
  EXPECT_EQ(o.vary[1].key, "solve.base.turbulence_m_s2");
}

TEST_F(Prior, of_another_event_takes_its_friction_as_drawn_and_leaves_its_release) {
  std::string draws =
      "solve.base.friction_angle_deg,preprocess.thickness_factor,solve.material.friction_angle_deg,"
      "log_likelihood\n";
  for (int k = 0; k < 60; ++k) draws += fmt::format("{},{},{},-3.5\n", 14 + 0.1 * k, 2, 40 - 0.2 * ((k * 7) % 60));
  scratch_.write("there.csv", draws);
  const EnsembleOptions o = expanded("there.csv", "law = \"coulomb\"\n");
  ASSERT_EQ(o.vary.size(), 2u) << "the release belongs to its own event";
  const MemberTable members = draw_members(o);
  const auto &bed = members.columns[0].values, &inside = members.columns[1].values;
  EXPECT_GE(*std::min_element(bed.begin(), bed.end()), 14);
  EXPECT_LE(*std::max_element(bed.begin(), bed.end()), 19.9);
  EXPECT_NEAR(openturns::library().rank_correlations({bed}, inside).front(), o.correlation[0].rank_correlation, 0.06);
  EXPECT_NEAR(Marginal(o.vary[0]).mean(), 16.95, 1e-9);
}

TEST_F(Prior, of_another_event_comes_in_the_form_of_friction_that_the_recipe_gives) {
  scratch_.write("there.csv", "solve.base.friction_angle_deg\n20\n22\n24\n");
  const EnsembleOptions o = expanded("there.csv", "law = \"coulomb\"\nfriction_coefficient = 0.3\n");
  ASSERT_EQ(o.vary.size(), 1u);
  EXPECT_EQ(o.vary[0].key, "solve.base.friction_coefficient");
  EXPECT_NEAR(Marginal(o.vary[0]).quantile(0.5), 0.404026, 1e-6) << "tan 22 degrees";
}

TEST_F(Prior, of_another_event_refuses_a_file_without_friction) {
  scratch_.write("there.csv", "preprocess.thickness_factor\n1\n2\n");
  EXPECT_TRUE(test::holds(refusal("there.csv", "law = \"coulomb\"\n"), {"gives no key of [solve]"}));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { expanded("absent.csv", "law = \"coulomb\"\n"); }),
                          {"absent.csv", "cannot be read"}));
}

}  // namespace
}  // namespace talus::preprocess
