// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction by a table.
#include "solver/boundary/laws/table.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/solver/boundary/any_law.hpp"

namespace talus::testing {
namespace {

BaseFriction<double> bed_of(std::vector<double> speeds, std::vector<double> coefficients) {
  OptionsOfLaws<FrictionLaws> o;
  o.table_speed = std::move(speeds);
  o.table_coefficient = std::move(coefficients);
  return some_bed<FrictionTable, FrictionLaws>(o);
}

template <class Real>
Real coefficient(const BaseFriction<Real>& f, Real speed) {
  return f.coefficient(f.uniform, {speed, 0, Real(0.01)});
}

TEST(FrictionTable, is_linear_between_its_rows_and_constant_beyond_them) {
  const auto f = bed_of({0.5, 1, 3}, {0.7, 0.5, 0.1});
  for (const auto& [speed, mu] :
       {std::pair{0.0, 0.7}, {0.5, 0.7}, {0.75, 0.6}, {1.0, 0.5}, {2.0, 0.3}, {3.0, 0.1}, {1e9, 0.1}})
    EXPECT_DOUBLE_EQ(coefficient(f, speed), mu) << speed;
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 2.0F), 0.3F);
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 1e9F), 0.1F);
}

TEST(FrictionTable, may_have_one_row_and_the_most_rows) {
  EXPECT_EQ(coefficient(bed_of({2}, {0.4}), 0.0), 0.4);
  EXPECT_EQ(coefficient(bed_of({2}, {0.4}), 9.0), 0.4);
  std::vector<double> rows(FrictionTable::most_rows);
  std::iota(rows.begin(), rows.end(), 0.0);
  const auto f = bed_of(rows, rows);  // mu = v
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
std::string fault_of(std::vector<double> speeds, std::vector<double> coefficients) {
  FrictionTable::Options o{std::move(speeds), std::move(coefficients)};
  std::vector<Fault> faults;
  o.describe(*recipe::make_checker(faults), {.name = "[solve.base]", .chosen = "table"});
  return faults.empty() ? "" : faults.front().what;
}

TEST(FrictionTable, is_refused_unless_its_rows_make_a_function) {
  EXPECT_EQ(fault_of({0, 1}, {0.3, 0.2}), "");
  EXPECT_EQ(fault_of({0, 1}, {0.3}), "[solve.base] table_speed_m_s has 2 values, table_coefficient 1");
  EXPECT_EQ(fault_of({0, 0}, {0.3, 0.2}), "[solve.base] table_speed_m_s is not increasing");
  EXPECT_EQ(fault_of({}, {}), "[solve.base] table_speed_m_s has 0 values");
  std::vector<double> many(25);
  std::iota(many.begin(), many.end(), 0.0);
  EXPECT_EQ(fault_of(many, many), "[solve.base] table_speed_m_s has 25 values");
}

}  // namespace
}  // namespace talus::testing
