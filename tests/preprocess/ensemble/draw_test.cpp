// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/draw.hpp"

#include <algorithm>
#include <numeric>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/SpaceFillingC2.hxx>
#include <set>

#include "preprocess/ensemble/design.hpp"
#include "tests/preprocess/ensemble/drawing.hpp"

namespace talus::preprocess {
namespace {

using test::ensemble;

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
  o.vary[0].distribution = Distribution::normal;
  o.vary[0].low = o.vary[0].high = std::nullopt;
  o.vary[0].mean = 15;
  o.vary[0].deviation = 2;
  const auto values = draw_members(o).columns[0].values;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 4000;
  EXPECT_NEAR(mean, 15, 4 * 2 / std::sqrt(4000.0)) << "four standard errors";
}

TEST(draw, keys_that_go_together_have_their_rank_correlation) {
  for (const Design design : {Design::monte_carlo, Design::sobol, Design::latin_hypercube}) {
    EnsembleOptions o = ensemble(4000, design, 3);
    o.vary[1].distribution = Distribution::lognormal;
    o.vary[1].low = o.vary[1].high = std::nullopt;
    o.vary[1].mean = 2;
    o.vary[1].deviation = 1;
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
  EXPECT_NE(fault_of_drawing(o).find("the correlations contradict one another (solve.a and solve.b: 0.9;"),
            std::string::npos);
  o.correlation = {{{"solve.a", "solve.b"}, 0.9}, {{"solve.b", "solve.a"}, 0.1}};
  EXPECT_NE(fault_of_drawing(o).find("is there twice"), std::string::npos);
}

TEST(draw, a_full_grid_has_every_combination_once) {
  EnsembleOptions o = ensemble(1, Design::full_grid, 2);
  o.levels = 4;
  VaryOptions& law = o.vary.emplace_back();
  law.key = "solve.law";
  law.distribution = Distribution::discrete;
  law.words = {"x", "y", "z"};
  const MemberTable table = draw_members(o);
  ASSERT_EQ(table.count, 4 * 4 * 3);
  std::set<std::vector<double>> members;
  for (std::size_t k = 0; k < 48; ++k)
    members.insert({table.columns[0].values[k], table.columns[1].values[k], table.columns[2].values[k]});
  EXPECT_EQ(members.size(), 48u);
  EXPECT_TRUE(members.contains({0.125, 0.875, 2}));
  o.levels = 1000;
  EXPECT_NE(fault_of_drawing(o).find("\"full-grid\" of 3e+06 members (up to 1000000 are run)"), std::string::npos);
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
  EXPECT_NE(fault_of_drawing(ensemble(9, Design::sensitivity, 3)).find("3 keys need at least 10"), std::string::npos);
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
  EXPECT_NE(fault("solve.a,solve.b\n1,2\n3\n").find("bad.csv:3:1: a row of 1 fields (the first has 2)"),
            std::string::npos);
  EXPECT_NE(fault("solve.a,solve.a\n1,2\n").find("bad.csv:1:9: solve.a is there twice"), std::string::npos);
  EXPECT_NE(fault("solve.a,solve.b\n1,\n").find("bad.csv:2:3: an empty field (solve.b has no value there)"),
            std::string::npos);
  EXPECT_NE(fault("1,2\n3,4\n").find("bad.csv:1:1: \"1\" is no key"), std::string::npos);
  EXPECT_NE(fault("solve.a\n").find("no members"), std::string::npos);
  EXPECT_NE(fault("solve.a\n\"1\n").find("bad.csv:2:1: a quote is not closed"), std::string::npos);
}

TEST(draw, what_does_not_go_with_a_design_is_refused) {
  EnsembleOptions o = ensemble(20, Design::sensitivity, 2);
  o.correlation = {{{"solve.a", "solve.b"}, 0.5}};
  EXPECT_NE(fault_of_drawing(o).find("design = \"sensitivity\" with [[ensemble.correlation]]"), std::string::npos);
  o.correlation.clear();
  o.elevation_error.terrain_deviation = 1;
  o.elevation_error.range = 100;
  EXPECT_NE(fault_of_drawing(o).find("with [ensemble.elevation_error]"), std::string::npos);
  o.design = Design::full_grid;
  o.vary.clear();
  EXPECT_NE(fault_of_drawing(o).find("without [[ensemble.vary]]"), std::string::npos);
  o = ensemble(20, Design::sobol, 1);
  o.keep = {"20"};
  EXPECT_NE(fault_of_drawing(o).find("keep names member 20 (there are 20, counted from 0)"), std::string::npos);
  EXPECT_NE(fault_of_drawing(ensemble(20, Design::sobol, 1112)).find("1111 directions"), std::string::npos);
  EXPECT_NE(fault_of_drawing(ensemble(100000, Design::optimal_hypercube, 3)).find("up to 200000 numbers are"),
            std::string::npos);
}

TEST(draw, whole_numbers_and_flags_are_written_as_keys_take_them) {
  MemberTable table;
  table.count = 1;
  table.columns = {{"solve.count", {3}, {}}, {"solve.x", {0.5}, {}}, {"solve.on", {0}, {"true"}}};
  EXPECT_EQ(table.values_of(0, ""), (std::vector<std::string>{"solve.count=3", "solve.x=0.5", "solve.on=true"}));
}

}  // namespace
}  // namespace talus::preprocess
