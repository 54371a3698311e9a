// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/marginal.hpp"

#include <numbers>

#include "tests/preprocess/ensemble/drawing.hpp"

namespace talus::preprocess {
namespace {

// Closed forms, to the rounding of a quantile that is found by iteration.
constexpr double rounding = 1e-7;

VaryOptions law(Distribution distribution) {
  VaryOptions o;
  o.key = "solve.a";
  o.distribution = distribution;
  return o;
}

TEST(marginal, uniform_is_between_its_bounds) {
  VaryOptions o = law(Distribution::uniform);
  o.low = -2;
  o.high = 6;
  const Marginal m(o);
  EXPECT_NEAR(m.quantile(0.25), 0, rounding);
  EXPECT_NEAR(m.mean(), 2, rounding);
  EXPECT_NEAR(m.deviation(), 8 / std::sqrt(12.0), rounding);
  EXPECT_EQ(m.levels(4).size(), 4u);
  EXPECT_NEAR(m.levels(4)[0], -1, rounding);
}

TEST(marginal, normal_has_its_quantiles_and_is_cut_where_bounds_say_so) {
  VaryOptions o = law(Distribution::normal);
  o.mean = 15;
  o.deviation = 2;
  EXPECT_NEAR(Marginal(o).quantile(0.975), 15 + 2 * 1.959963985, 1e-6);
  EXPECT_NEAR(Marginal(o).deviation(), 2, rounding);
  o.low = 15;  // half a normal distribution: mean + deviation * sqrt(2/pi)
  const Marginal half(o);
  EXPECT_NEAR(half.mean(), 15 + 2 * std::sqrt(2 / std::numbers::pi), 1e-5);
  EXPECT_NEAR(half.deviation(), 2 * std::sqrt(1 - 2 / std::numbers::pi), 1e-5);
  EXPECT_NEAR(half.quantile(0.5), 15 + 2 * 0.6744897502, 1e-5) << "the quartile of the whole";
  EXPECT_GE(half.quantile(1e-12), 15 - rounding);
  o.high = 17;
  EXPECT_NEAR(Marginal(o).quantile(1 - 1e-12), 17, 1e-5);
  EXPECT_NEAR(Marginal(o).quantile(0.5), 15 + 2 * 0.4417, 1e-3) << "Phi(z) = 1/2 + (Phi(1) - 1/2) / 2";
}

TEST(marginal, lognormal_has_the_mean_and_deviation_of_the_value) {
  VaryOptions o = law(Distribution::lognormal);
  o.mean = 500;
  o.deviation = 250;
  const Marginal m(o);
  EXPECT_NEAR(m.mean(), 500, 1e-6);
  EXPECT_NEAR(m.deviation(), 250, 1e-6);
  EXPECT_NEAR(m.quantile(0.5), 500 / std::sqrt(1 + 0.25), 1e-5) << "median = mean / sqrt(1 + cv^2)";
  o.high = 500;
  EXPECT_LE(Marginal(o).quantile(1 - 1e-12), 500 + 1e-6);
}

TEST(marginal, triangular_and_beta_have_their_moments) {
  VaryOptions o = law(Distribution::triangular);
  o.low = 0;
  o.high = 10;
  o.mode = 4;
  EXPECT_NEAR(Marginal(o).mean(), 14 / 3.0, rounding);
  EXPECT_NEAR(Marginal(o).quantile(0.4), 4, rounding) << "the share left of the mode";
  VaryOptions b = law(Distribution::beta);
  b.low = 10;
  b.high = 30;
  b.mean = 15;
  b.deviation = 3;
  EXPECT_NEAR(Marginal(b).mean(), 15, 1e-6);
  EXPECT_NEAR(Marginal(b).deviation(), 3, 1e-6);
  b.mean = 20;
  b.deviation = 20 / std::sqrt(12.0);  // which is uniform
  EXPECT_NEAR(Marginal(b).quantile(0.1), 12, 1e-6);
}

TEST(marginal, of_a_table_is_linear_between_its_rows) {
  const test::Scratch scratch;
  VaryOptions o = law(Distribution::table);
  o.table = scratch.write("density.csv", "value,density\n0, 0\n1, 2\n3, 2\n4, 0\n");  // a trapezium of area 6
  const Marginal m(o);
  EXPECT_NEAR(m.mean(), 2, 1e-6);
  EXPECT_NEAR(m.quantile(0.5), 2, 1e-5);
  EXPECT_NEAR(m.quantile(1 / 6.0), 1, 1e-5);
  EXPECT_NEAR(m.quantile(0.25 / 6), 0.5, 1e-5) << "the area under 2 x is x^2";
  const auto fault = [&](const std::string& text) {
    o.table = scratch.write("bad.csv", text);
    return test::fault_of<DataError>([&] { Marginal{o}; });
  };
  EXPECT_NE(fault("0,1\n1,1\n1,2\n").find("bad.csv:3:1: 1 does not lie above the value before"), std::string::npos);
  EXPECT_NE(fault("0,1\n1,-1\n").find("bad.csv:2:3: -1 is negative"), std::string::npos);
  EXPECT_NE(fault("0,1\n1,x\n").find("bad.csv:2:3: \"x\" is no number"), std::string::npos);
  EXPECT_NE(fault("0,0\n1,0\n").find("all densities are 0"), std::string::npos);
  EXPECT_NE(fault("0,1\n").find("fewer than two rows"), std::string::npos);
}

TEST(marginal, discrete_takes_its_values_by_weight) {
  VaryOptions o = law(Distribution::discrete);
  o.values = {30, 10, 20};
  o.weights = {1, 2, 1};
  const Marginal m(o);
  EXPECT_EQ(m.quantile(0.49), 10);
  EXPECT_EQ(m.quantile(0.51), 20);
  EXPECT_EQ(m.quantile(0.99), 30);
  EXPECT_NEAR(m.mean(), 17.5, 1e-12);
  EXPECT_NEAR(m.deviation(), std::sqrt((2 * 56.25 + 6.25 + 156.25) / 4), 1e-9);
  EXPECT_EQ(m.levels(7), (std::vector<double>{10, 20, 30}));
  VaryOptions words = law(Distribution::discrete);
  words.words = {"mohr-coulomb", "voellmy", "herschel-bulkley"};
  words.weights = {1, 0, 3};
  const Marginal w(words);
  EXPECT_EQ(w.words(), (std::vector<std::string>{"mohr-coulomb", "herschel-bulkley"}));
  EXPECT_EQ(w.quantile(0.2), 0);
  EXPECT_EQ(w.quantile(0.3), 1);
}

TEST(marginal, that_cannot_be_is_refused_with_the_reason) {
  const auto fault = [](const VaryOptions& o) { return test::fault_of<RecipeError>([&] { Marginal{o}; }); };
  VaryOptions normal = law(Distribution::normal);
  normal.mean = 15;
  normal.deviation = 1;
  normal.low = 25;
  normal.high = 30;
  EXPECT_NE(fault(normal).find("low and high leave 0 of the distribution"), std::string::npos) << fault(normal);
  VaryOptions beta = law(Distribution::beta);
  beta.low = 0;
  beta.high = 1;
  beta.mean = 0.5;
  beta.deviation = 0.5;
  EXPECT_NE(fault(beta).find("deviation = 0.5 is too large"), std::string::npos);
  beta.mean = 2;
  EXPECT_NE(fault(beta).find("mean = 2 is not between low and high"), std::string::npos);
  VaryOptions discrete = law(Distribution::discrete);
  discrete.values = {1, 2, 1};
  EXPECT_NE(fault(discrete).find("a value is there twice"), std::string::npos);
  discrete.words = {"a"};
  EXPECT_NE(fault(discrete).find("values and words are both given"), std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
