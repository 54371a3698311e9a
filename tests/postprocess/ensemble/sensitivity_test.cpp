// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace talus::postprocess {
namespace {

/// Ishigami and Homma's function (1990), a = 7, b = 0.1, on [-pi, pi]^3.
double ishigami(const std::vector<double>& x) {
  return std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

/// A design of N (d + 2) members: the samples A and B, and for each key A with that key's values of B. The points are
/// Roberts' additive recurrence in six dimensions, which fills the cube more evenly than chance.
MemberTable sobol_design(std::size_t size, std::size_t keys) {
  double phi = 2;
  for (int n = 0; n < 50; ++n) phi = std::pow(1 + phi, 1.0 / (2 * static_cast<double>(keys) + 1));
  const auto draw = [&](std::size_t k, std::size_t column) {
    const double power = static_cast<double>(column + 1);
    const double u = std::fmod(0.5 + static_cast<double>(k + 1) * std::pow(1 / phi, power), 1.0);
    return std::numbers::pi * (2 * u - 1);
  };
  MemberTable table;
  table.design = "sensitivity";
  table.sample_size = static_cast<std::int64_t>(size);
  table.count = static_cast<std::int64_t>(size * (keys + 2));
  for (std::size_t key = 0; key < keys; ++key) {
    MemberColumn column{"x" + std::to_string(key + 1), {}, {}};
    for (std::size_t block = 0; block < keys + 2; ++block)
      for (std::size_t k = 0; k < size; ++k)
        column.values.push_back(draw(k, block == 1 || block == key + 2 ? keys + key : key));
    table.columns.push_back(column);
  }
  return table;
}

std::vector<double> results_of(const MemberTable& table, double (*function)(const std::vector<double>&)) {
  std::vector<double> results;
  for (std::size_t k = 0; k < static_cast<std::size_t>(table.count); ++k) {
    std::vector<double> x;
    for (const MemberColumn& column : table.columns) x.push_back(column.values[k]);
    results.push_back(function(x));
  }
  return results;
}

double index_of(const Sensitivity& found, const std::string& key, SensitivityMeasure measure) {
  for (const SensitivityIndex& index : found.indices)
    if (index.key == key && index.measure == measure) return index.value;
  ADD_FAILURE() << "no " << measure_name(measure) << " of " << key;
  return nan;
}

TEST(Sensitivity, gives_the_sobol_indices_of_ishigamis_function) {
  const MemberTable table = sobol_design(4096, 3);
  const Sensitivity found = sensitivity(table, results_of(table, ishigami));
  const double first[] = {0.3139, 0.4424, 0.0}, total[] = {0.5576, 0.4424, 0.2437};
  for (int n = 0; n < 3; ++n) {
    const std::string key = "x" + std::to_string(n + 1);
    // Independent draws would scatter by about 0.02; these points are more even.
    EXPECT_NEAR(index_of(found, key, SensitivityMeasure::first_order), first[n], 0.02) << key;
    EXPECT_NEAR(index_of(found, key, SensitivityMeasure::total_order), total[n], 0.02) << key;
  }
  EXPECT_EQ(found.members, table.count);
  for (const SensitivityIndex& index : found.indices) {
    EXPECT_LT(index.low, index.value) << index.key;
    EXPECT_GT(index.high, index.value) << index.key;
    EXPECT_LT(index.high - index.low, 0.2) << index.key;
  }
}

TEST(Sensitivity, gives_the_same_numbers_again) {
  const MemberTable table = sobol_design(64, 3);
  const auto results = results_of(table, ishigami);
  const Sensitivity once = sensitivity(table, results), again = sensitivity(table, results);
  for (std::size_t n = 0; n < once.indices.size(); ++n) {
    EXPECT_EQ(once.indices[n].value, again.indices[n].value);
    EXPECT_EQ(once.indices[n].low, again.indices[n].low);
  }
}

TEST(Sensitivity, leaves_out_the_rows_of_a_sobol_design_in_which_a_member_failed) {
  const MemberTable table = sobol_design(1024, 3);
  auto results = results_of(table, ishigami);
  for (std::size_t k = 5; k < results.size(); k += 97) results[k] = nan;
  const Sensitivity found = sensitivity(table, results);
  EXPECT_LT(found.members, table.count);
  EXPECT_NE(found.note.find("of 1024 rows of the design are left out"), std::string::npos) << found.note;
  EXPECT_NEAR(index_of(found, "x2", SensitivityMeasure::first_order), 0.4424, 0.08);
}

MemberTable drawn(std::int64_t members, const std::string& design) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  MemberTable table{design, 3, members, 0, {{"a", {}, {}}, {"b", {}, {}}, {"law", {}, {"one", "two", "three"}}},
                    {},     {}};
  for (std::int64_t k = 0; k < members; ++k) {
    table.columns[0].values.push_back(normal(random));
    table.columns[1].values.push_back(normal(random));
    table.columns[2].values.push_back(static_cast<double>(k % 3));
  }
  return table;
}

TEST(Sensitivity, gives_rank_correlations_that_do_not_care_for_the_scale) {
  const MemberTable table = drawn(2000, "latin-hypercube");
  const Sensitivity found =
      sensitivity(table, results_of(table, [](const std::vector<double>& x) { return std::exp(3 * x[0] - 4 * x[1]); }));
  // Of a sum of normal variables with weights .6 and -.8: Spearman's is 6 / pi asin(r / 2).
  EXPECT_NEAR(index_of(found, "a", SensitivityMeasure::spearman), 6 / std::numbers::pi * std::asin(0.3), 0.04);
  EXPECT_NEAR(index_of(found, "b", SensitivityMeasure::spearman), -6 / std::numbers::pi * std::asin(0.4), 0.04);
  EXPECT_NEAR(index_of(found, "a", SensitivityMeasure::srrc), 0.6, 0.06);
  EXPECT_NEAR(index_of(found, "b", SensitivityMeasure::srrc), -0.8, 0.06);
  EXPECT_NE(found.note.find("no ranks: law"), std::string::npos) << "three words have no order";
  for (const SensitivityIndex& index : found.indices)
    if (index.measure == SensitivityMeasure::spearman) {
      const double width = 2 * 1.96 * std::sqrt(1.06 / 1997) * (1 - index.value * index.value);  // to first order
      EXPECT_NEAR(index.high - index.low, width, 0.01 * width);
      EXPECT_LT(index.low, index.value);
    }
}

TEST(Sensitivity, says_why_there_is_none) {
  const MemberTable table = drawn(10, "sobol");
  EXPECT_EQ(sensitivity(table, std::vector<double>(10, 3.0)).note, "the result is the same in all members");
  std::vector<double> failed(10, nan);
  failed[0] = 1;
  EXPECT_EQ(sensitivity(table, failed).note, "too few members");
  EXPECT_THROW(sensitivity(table, {1, 2}), std::logic_error);
}

TEST(Sensitivity, gives_the_swing_of_keys_that_vary_alone) {
  MemberTable table{"one-at-a-time", 1, 5, 0, {{"a", {5, 1, 9, 5, 5}, {}}, {"b", {2, 2, 2, 0, 4}, {}}}, {}, {}};
  const Sensitivity found = sensitivity(table, {10, 4, 20, 9, nan});
  EXPECT_EQ(index_of(found, "a", SensitivityMeasure::swing), 16);
  EXPECT_EQ(index_of(found, "b", SensitivityMeasure::swing), 1);
}

}  // namespace
}  // namespace talus::postprocess
