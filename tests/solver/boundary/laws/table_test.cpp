// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction by a table.
#include "solver/boundary/laws/table.hpp"

#include <gtest/gtest.h>

#include "tests/solver/boundary/any_law.hpp"

namespace talus::testing {
namespace {

BaseFriction<double> bed_of(recipe::Pairs rows) {
  OptionsOfLaws<FrictionLaws> o;
  o.table = std::move(rows);
  return some_bed<FrictionTable, FrictionLaws>(o);
}

/// Rows of a coefficient as large as the speed.
recipe::Pairs as_many(int rows) {
  recipe::Pairs table;
  for (int row = 0; row < rows; ++row) table.push_back({1.0 * row, 1.0 * row});
  return table;
}

template <class Real>
Real coefficient(const BaseFriction<Real>& f, Real speed) {
  return f.coefficient(f.uniform, {speed, 0, Real(0.01)});
}

TEST(FrictionTable, is_linear_between_its_rows_and_constant_beyond_them) {
  const auto f = bed_of({{0.5, 0.7}, {1, 0.5}, {3, 0.1}});
  for (const auto& [speed, mu] :
       {std::pair{0.0, 0.7}, {0.5, 0.7}, {0.75, 0.6}, {1.0, 0.5}, {2.0, 0.3}, {3.0, 0.1}, {1e9, 0.1}})
    EXPECT_DOUBLE_EQ(coefficient(f, speed), mu) << speed;
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 2.0F), 0.3F);
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 1e9F), 0.1F);
}

TEST(FrictionTable, may_have_one_row_and_the_most_rows) {
  EXPECT_EQ(coefficient(bed_of({{2, 0.4}}), 0.0), 0.4);
  EXPECT_EQ(coefficient(bed_of({{2, 0.4}}), 9.0), 0.4);
  const auto f = bed_of(as_many(FrictionTable::most_rows));  // mu = v
  for (const double speed : {0.0, 0.3, 22.5, 23.0}) EXPECT_DOUBLE_EQ(coefficient(f, speed), speed);
  EXPECT_EQ(coefficient(f, 24.0), 23);
}

TEST(FrictionTable, carries_its_share_of_the_normal_stress) {
  double numbers[FrictionTable::constant_count];
  FrictionTable::constants(OptionsOfLaws<FrictionLaws>{}, {.borne = 0.25, .density = 0, .gravity = 0}, numbers);
  EXPECT_EQ(numbers[FrictionTable::mu], 0.25 * 0.6);
  EXPECT_EQ(numbers[FrictionTable::speed + 1], 10);
}

/// The fault of a table; "" where there is none.
std::string fault_of(recipe::Pairs rows) {
  FrictionTable::Options o{std::move(rows)};
  std::vector<Fault> faults;
  o.describe(*recipe::make_checker(faults), {.name = "[solve.base]", .chosen = "table"});
  return faults.empty() ? "" : faults.front().what;
}

TEST(FrictionTable, is_refused_unless_its_rows_make_a_function) {
  EXPECT_EQ(fault_of({{0, 0.3}, {1, 0.2}}), "");
  EXPECT_EQ(fault_of({{0, 0.3}, {0, 0.2}}), "[solve.base] table: speeds do not increase");
  EXPECT_EQ(fault_of({}), "[solve.base] table has 0 rows");
  EXPECT_EQ(fault_of(as_many(25)), "[solve.base] table has 25 rows");
}

}  // namespace
}  // namespace talus::testing
