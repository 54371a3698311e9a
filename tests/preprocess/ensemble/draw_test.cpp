// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/SpaceFillingC2.hxx>

#include "preprocess/ensemble/marginal.hpp"
#include "tests/preprocess/ensemble/drawing.hpp"

namespace talus::preprocess {
namespace {

using test::ensemble;
using test::holds;

// Closed forms, to the rounding of a quantile that is found by iteration.
constexpr double rounding = 1e-7;

/// The key a as it varies.
VaryOptions varied(Distribution distribution, std::optional<double> low = {}, std::optional<double> high = {},
                   std::optional<double> mean = {}, std::optional<double> deviation = {}) {
  VaryOptions o;
  o.key = "solve.a";
  o.distribution = distribution;
  o.low = low;
  o.high = high;
  o.mean = mean;
  o.deviation = deviation;
  return o;
}

TEST(marginal, uniform_is_between_its_bounds_and_lognormal_has_the_mean_and_deviation_of_the_value) {
  VaryOptions o = varied(Distribution::uniform, -2, 6);
  const Marginal m(o);
  EXPECT_NEAR(m.quantile(0.25), 0, rounding);
  EXPECT_NEAR(m.mean(), 2, rounding);
  EXPECT_NEAR(m.deviation(), 8 / std::sqrt(12.0), rounding);
  EXPECT_EQ(m.levels(4).size(), 4u);
  EXPECT_NEAR(m.levels(4)[0], -1, rounding);
  VaryOptions log = varied(Distribution::lognormal, {}, {}, 500, 250);
  const Marginal l(log);
  EXPECT_NEAR(l.mean(), 500, 1e-6);
  EXPECT_NEAR(l.deviation(), 250, 1e-6);
  EXPECT_NEAR(l.quantile(0.5), 500 / std::sqrt(1 + 0.25), 1e-5) << "median = mean / sqrt(1 + cv^2)";
  log.high = 500;
  EXPECT_LE(Marginal(log).quantile(1 - 1e-12), 500 + 1e-6);
}

TEST(marginal, normal_has_its_quantiles_and_is_cut_where_bounds_say_so) {
  VaryOptions o = varied(Distribution::normal, {}, {}, 15, 2);
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

TEST(marginal, triangular_and_beta_have_their_moments) {
  VaryOptions o = varied(Distribution::triangular, 0, 10);
  o.mode = 4;
  EXPECT_NEAR(Marginal(o).mean(), 14 / 3.0, rounding);
  EXPECT_NEAR(Marginal(o).quantile(0.4), 4, rounding) << "the share left of the mode";
  VaryOptions b = varied(Distribution::beta, 10, 30, 15, 3);
  EXPECT_NEAR(Marginal(b).mean(), 15, 1e-6);
  EXPECT_NEAR(Marginal(b).deviation(), 3, 1e-6);
  b.mean = 20;
  b.deviation = 20 / std::sqrt(12.0);  // which is uniform
  EXPECT_NEAR(Marginal(b).quantile(0.1), 12, 1e-6);
}

TEST(marginal, of_a_table_is_linear_between_its_rows) {
  const test::Scratch scratch;
  VaryOptions o = varied(Distribution::table);
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
  EXPECT_TRUE(holds(fault("0,1\n1,1\n1,2\n"), {"bad.csv:3:1: 1 does not lie above the value before"}));
  EXPECT_TRUE(holds(fault("0,1\n1,-1\n"), {"bad.csv:2:3: -1 is negative"}));
  EXPECT_TRUE(holds(fault("0,1\n1,x\n"), {"bad.csv:2:3: \"x\" is no number"}));
  EXPECT_TRUE(holds(fault("0,0\n1,0\n"), {"all densities are 0"}));
  EXPECT_TRUE(holds(fault("0,1\n"), {"fewer than two rows"}));
}

TEST(marginal, discrete_takes_its_values_by_weight) {
  VaryOptions o = varied(Distribution::discrete), words = o;
  o.values = {30, 10, 20};
  o.weights = {1, 2, 1};
  const Marginal m(o);
  EXPECT_EQ(m.quantile(0.49), 10);
  EXPECT_EQ(m.quantile(0.51), 20);
  EXPECT_EQ(m.quantile(0.99), 30);
  EXPECT_NEAR(m.mean(), 17.5, 1e-12);
  EXPECT_NEAR(m.deviation(), std::sqrt((2 * 56.25 + 6.25 + 156.25) / 4), 1e-9);
  EXPECT_EQ(m.levels(7), (std::vector<double>{10, 20, 30}));
  words.words = {"mohr-coulomb", "voellmy", "herschel-bulkley"};
  words.weights = {1, 0, 3};
  const Marginal w(words);
  EXPECT_EQ(w.words(), (std::vector<std::string>{"mohr-coulomb", "herschel-bulkley"}));
  EXPECT_EQ(w.quantile(0.2), 0);
  EXPECT_EQ(w.quantile(0.3), 1);
}

TEST(marginal, that_cannot_be_is_refused_with_the_reason) {
  const auto fault = [](const VaryOptions& o) { return test::fault_of<RecipeError>([&] { Marginal{o}; }); };
  EXPECT_TRUE(holds(fault(varied(Distribution::normal, 25, 30, 15, 1)), {"low and high leave 0 of the distribution"}));
  VaryOptions beta = varied(Distribution::beta, 0, 1, 0.5, 0.5), discrete = varied(Distribution::discrete);
  EXPECT_TRUE(holds(fault(beta), {"deviation = 0.5 is too large"}));
  beta.mean = 2;
  EXPECT_TRUE(holds(fault(beta), {"mean = 2 is not between low and high"}));
  discrete.values = {1, 2, 1};
  EXPECT_TRUE(holds(fault(discrete), {"a value is there twice"}));
  discrete.words = {"a"};
  EXPECT_TRUE(holds(fault(discrete), {"values and words are both given"}));
}

/// Places of values in growing order.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t r = 0; r < order.size(); ++r) ranks[order[r]] = static_cast<double>(r);
  return ranks;
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ra = ranks_of(a), rb = ranks_of(b);
  const double n = static_cast<double>(a.size()), middle = (n - 1) / 2;
  double both = 0;
  for (std::size_t i = 0; i < a.size(); ++i) both += (ra[i] - middle) * (rb[i] - middle);
  return both / (n * (n * n - 1) / 12);
}

std::string fault_of_drawing(const EnsembleOptions& o) {
  return test::fault_of<RecipeError>([&] { draw_members(o); });
}

/// True where every stratum (k / n, (k + 1) / n) of a column holds one value.
bool in_strata(const std::vector<double>& values) {
  std::set<int> strata;
  for (const double v : values) strata.insert(static_cast<int>(v * static_cast<double>(values.size())));
  return strata.size() == values.size();
}

TEST(draw, sobol_members_are_the_sequence_of_openturns_shifted_modulo_one) {
  const MemberTable table = draw_members(ensemble(40, Design::sobol, 3));
  ASSERT_EQ(table.count, 40);
  const OT::Sample sequence = OT::SobolSequence(3).generate(40);
  for (std::size_t d = 0; d < 3; ++d) {
    const auto& values = table.columns[d].values;
    const double shift = values[0] - sequence(0, d);
    for (std::size_t k = 0; k < 40; ++k) {
      const double turn = values[k] - sequence(k, d) - shift;
      EXPECT_NEAR(turn, std::round(turn), 1e-12);
    }
  }
}

TEST(draw, latin_hypercubes_have_one_member_in_each_stratum) {
  for (const Design design : {Design::latin_hypercube, Design::optimal_hypercube})
    for (const MemberColumn& column : draw_members(ensemble(24, design, 4)).columns)
      EXPECT_TRUE(in_strata(column.values)) << column.key;
}

TEST(draw, an_optimal_hypercube_fills_the_space_better) {
  const auto discrepancy = [](Design design) {
    double sum = 0;
    for (int seed = 1; seed <= 5; ++seed) {
      const auto shares = unit_design(design, 24, 3, seed).shares;
      OT::Sample sample(24, 3);
      for (OT::UnsignedInteger k = 0; k < 24; ++k)
        for (OT::UnsignedInteger d = 0; d < 3; ++d) sample(k, d) = shares[k][d];
      sum += OT::SpaceFillingC2().evaluate(sample);
    }
    return sum;
  };
  EXPECT_LT(discrepancy(Design::optimal_hypercube), 0.8 * discrepancy(Design::latin_hypercube));
}

TEST(draw, a_seed_gives_one_table_and_another_seed_another) {
  for (const Design design :
       {Design::sobol, Design::latin_hypercube, Design::optimal_hypercube, Design::monte_carlo, Design::sensitivity}) {
    EnsembleOptions o = ensemble(20, design, 2);
    const MemberTable one = draw_members(o), same = draw_members(o);
    o.seed = 2;
    const MemberTable other = draw_members(o);
    for (std::size_t d = 0; d < 2; ++d) {
      EXPECT_EQ(one.columns[d].values, same.columns[d].values) << one.design;
      EXPECT_NE(one.columns[d].values, other.columns[d].values) << one.design;
    }
  }
}

TEST(draw, monte_carlo_has_the_moments_of_the_distribution) {
  EnsembleOptions o = ensemble(4000, Design::monte_carlo, 1);
  o.vary[0] = varied(Distribution::normal, {}, {}, 15, 2);
  const auto values = draw_members(o).columns[0].values;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 4000;
  EXPECT_NEAR(mean, 15, 4 * 2 / std::sqrt(4000.0)) << "four standard errors";
}

TEST(draw, keys_that_go_together_have_their_rank_correlation) {
  for (const Design design : {Design::monte_carlo, Design::sobol, Design::latin_hypercube}) {
    EnsembleOptions o = ensemble(4000, design, 3);
    o.vary[1] = varied(Distribution::lognormal, {}, {}, 2, 1);
    o.vary[1].key = "solve.b";
    o.correlation = {{{"solve.a", "solve.b"}, -0.7}, {{"solve.c", "solve.b"}, 0.3}};
    const MemberTable table = draw_members(o);
    const auto& c = table.columns;
    // The standard error of a rank correlation of 4000 draws is below 0.016.
    EXPECT_NEAR(rank_correlation(c[0].values, c[1].values), -0.7, 0.06) << table.design;
    EXPECT_NEAR(rank_correlation(c[1].values, c[2].values), 0.3, 0.06) << table.design;
    EXPECT_NEAR(rank_correlation(c[0].values, c[2].values), 0, 0.06) << table.design;
  }
  EnsembleOptions o = ensemble(10, Design::sobol, 3);
  o.correlation = {{{"solve.a", "solve.b"}, 0.9}, {{"solve.b", "solve.c"}, 0.9}, {{"solve.a", "solve.c"}, -0.9}};
  EXPECT_TRUE(holds(fault_of_drawing(o), {"the correlations contradict one another (solve.a and solve.b: 0.9;"}));
  o.correlation = {{{"solve.a", "solve.b"}, 0.9}, {{"solve.b", "solve.a"}, 0.1}};
  EXPECT_TRUE(holds(fault_of_drawing(o), {"is there twice"}));
}

TEST(draw, a_full_grid_has_every_combination_once) {
  EnsembleOptions o = ensemble(1, Design::full_grid, 2);
  o.levels = 4;
  o.vary.push_back(varied(Distribution::discrete));
  o.vary.back().key = "solve.law";
  o.vary.back().words = {"x", "y", "z"};
  const MemberTable table = draw_members(o);
  ASSERT_EQ(table.count, 4 * 4 * 3);
  std::set<std::vector<double>> members;
  for (std::size_t k = 0; k < 48; ++k)
    members.insert({table.columns[0].values[k], table.columns[1].values[k], table.columns[2].values[k]});
  EXPECT_EQ(members.size(), 48u);
  EXPECT_TRUE(members.contains({0.125, 0.875, 2}));
  o.levels = 1000;
  EXPECT_TRUE(holds(fault_of_drawing(o), {"\"full-grid\" of 3e+06 members (up to 1000000 are run)"}));
}

TEST(draw, one_at_a_time_changes_one_key_of_the_middle) {
  for (const int levels : {4, 5}) {
    EnsembleOptions o = ensemble(1, Design::one_at_a_time, 3);
    o.levels = levels;
    const MemberTable table = draw_members(o);
    EXPECT_EQ(table.count, 1 + 3 * 4) << "of an odd number of levels one is the middle";
    for (std::size_t k = 0; k < static_cast<std::size_t>(table.count); ++k) {
      int changed = 0;
      for (const MemberColumn& column : table.columns) changed += std::abs(column.values[k] - 0.5) > 1e-12;
      EXPECT_EQ(changed, k == 0 ? 0 : 1);
    }
  }
}

TEST(draw, sensitivity_mixes_two_samples_as_saltelli_does) {
  const MemberTable table = draw_members(ensemble(103, Design::sensitivity, 3));
  ASSERT_EQ(table.sample_size, 20) << "the largest with N (3 + 2) <= 103";
  ASSERT_EQ(table.count, 100);
  const auto at = [&](std::size_t d, std::int64_t block, std::int64_t n) {
    return table.columns[d].values[static_cast<std::size_t>(block * 20 + n)];
  };
  for (std::size_t key = 0; key < 3; ++key)
    for (std::size_t d = 0; d < 3; ++d)
      for (std::int64_t n = 0; n < 20; ++n)
        EXPECT_EQ(at(d, 2 + static_cast<std::int64_t>(key), n), at(d, d == key ? 1 : 0, n));
  EXPECT_TRUE(holds(fault_of_drawing(ensemble(9, Design::sensitivity, 3)), {"3 keys need at least 10"}));
}

TEST(draw, a_file_lists_members) {
  const test::Scratch scratch;
  EnsembleOptions o;
  o.members = 1;
  o.design = Design::table;
  o.table = scratch.write("members.csv", "\xEF\xBB\xBF# laws\nsolve.a, \"solve.law\"\r\n1,x\n\n2.5e1,\"y\"\n-3,x\n");
  const MemberTable table = draw_members(o);
  ASSERT_EQ(table.count, 3);
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{1, 25, -3}));
  EXPECT_EQ(table.columns[1].words, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(table.values_of(1, "solve."), (std::vector<std::string>{"solve.a=25", "solve.law=\"y\""}));
  const auto fault = [&](const std::string& text) {
    o.table = scratch.write("bad.csv", text);
    return test::fault_of<DataError>([&] { draw_members(o); });
  };
  EXPECT_TRUE(holds(fault("solve.a,solve.b\n1,2\n3\n"), {"bad.csv:3:1: a row of 1 fields (the first has 2)"}));
  EXPECT_TRUE(holds(fault("solve.a,solve.a\n1,2\n"), {"bad.csv:1:9: solve.a is there twice"}));
  EXPECT_TRUE(holds(fault("solve.a,solve.b\n1,\n"), {"bad.csv:2:3: an empty field (solve.b has no value there)"}));
  EXPECT_TRUE(holds(fault("1,2\n3,4\n"), {"bad.csv:1:1: \"1\" is no key"}));
  EXPECT_TRUE(holds(fault("solve.a\n"), {"no members"}));
  EXPECT_TRUE(holds(fault("solve.a\n\"1\n"), {"bad.csv:2:1: a quote is not closed"}));
}

TEST(draw, a_file_of_any_locale_is_read_or_refused_by_its_place) {
  const test::Scratch scratch;
  EnsembleOptions o;
  o.members = 1;
  o.design = Design::table;
  const auto drawn = [&](const std::string& text) {
    o.table = scratch.write("members.csv", text);
    return draw_members(o);
  };
  for (const char* text :
       {"solve.a,solve.law\n1.5,x\n-2.25,y\n", "solve.a;solve.law\n1,5;x\n-2,25;y\n",
        "solve.a\tsolve.law\n1,5\tx\n-2,25\ty\n", "\xEF\xBB\xBFsolve.a;solve.law\r\n1,5;x\r\n-2,25;y\r\n"}) {
    const MemberTable table = drawn(text);
    ASSERT_EQ(table.columns.size(), 2u) << text;
    EXPECT_EQ(table.columns[0].values, (std::vector<double>{1.5, -2.25})) << text;
    EXPECT_EQ(table.columns[1].words, (std::vector<std::string>{"x", "y"})) << text;
  }
  EXPECT_EQ(drawn("solve.file\nH\xf6he.asc\nb.asc\n").columns[0].words[0], "H\u00f6he.asc");
  const auto fault = [&](const std::string& text) { return test::fault_of<DataError>([&] { drawn(text); }); };
  for (const char* number : {"\"1,234.5\"", "1'234.5", "1 234.5", "\"1,5\""})
    EXPECT_TRUE(holds(fault(std::string("solve.a,solve.b\n1,") + number + "\n"), {"members.csv:2:3:", "is no number"}))
        << number;
  EXPECT_TRUE(holds(fault("solve.a;solve.b\n1;1.234,5\n"), {"members.csv:2:3:", "is no number"}));
  EXPECT_TRUE(holds(fault("solve.a;solve.b\n1;1,234\n"), {"members.csv:2:3: \"1,234\"", "1.234, or 1234"}));
  EXPECT_TRUE(holds(fault("solve.a;solve.b\n1,5;1.5\n"), {"members.csv:2:5: \"1.5\"", "commas and decimal points"}));
  EXPECT_TRUE(holds(fault(std::string("s\0o\0l\0v\0e\0", 10)), {"its text is UTF-16LE", "iconv -f UTF-16LE"}));
}

TEST(draw, what_does_not_go_with_a_design_is_refused) {
  EnsembleOptions o = ensemble(20, Design::sensitivity, 2);
  o.correlation = {{{"solve.a", "solve.b"}, 0.5}};
  EXPECT_TRUE(holds(fault_of_drawing(o), {"design = \"sensitivity\" with [[ensemble.correlation]]"}));
  o.correlation.clear();
  o.elevation_error.terrain_deviation = 1;
  o.elevation_error.range = 100;
  EXPECT_TRUE(holds(fault_of_drawing(o), {"with [ensemble.elevation_error]"}));
  o.design = Design::full_grid;
  o.vary.clear();
  EXPECT_TRUE(holds(fault_of_drawing(o), {"without [[ensemble.vary]]"}));
  o = ensemble(20, Design::sobol, 1);
  o.keep = {"20"};
  EXPECT_TRUE(holds(fault_of_drawing(o), {"keep names member 20 (there are 20, counted from 0)"}));
  EXPECT_TRUE(holds(fault_of_drawing(ensemble(20, Design::sobol, 1112)), {"1111 directions"}));
  EXPECT_TRUE(holds(fault_of_drawing(ensemble(100000, Design::optimal_hypercube, 3)), {"up to 200000 numbers are"}));
}

TEST(draw, whole_numbers_and_flags_are_written_as_keys_take_them) {
  MemberTable table;
  table.count = 1;
  table.columns = {{"solve.count", {3}, {}}, {"solve.x", {0.5}, {}}, {"solve.on", {0}, {"true"}}};
  EXPECT_EQ(table.values_of(0, ""), (std::vector<std::string>{"solve.count=3", "solve.x=0.5", "solve.on=true"}));
}

}  // namespace
}  // namespace talus::preprocess
