// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Hydrographs: their integral, and files that are none.
#include "solver/scene/hydrograph.hpp"

#include "tests/common/scratch.hpp"

namespace talus::solver::testing {
namespace {

using test::fault_of;
using test::Scratch;

TEST(Hydrograph, is_the_integral_of_straight_lines_to_rounding) {
  const Hydrograph h({10, 20, 40, 50, 60}, {0, 8, 8, 0, 6});
  EXPECT_EQ(h.volume_until(0), 0);
  EXPECT_EQ(h.volume_until(10), 0);
  EXPECT_DOUBLE_EQ(h.volume_until(15), 0.5 * 5 * 4);
  EXPECT_DOUBLE_EQ(h.volume_until(20), 40);
  EXPECT_DOUBLE_EQ(h.volume_until(30), 120);
  EXPECT_DOUBLE_EQ(h.volume_until(45), 40 + 160 + 5 * 6);
  EXPECT_DOUBLE_EQ(h.volume_until(60), 40 + 160 + 40 + 30);
  EXPECT_DOUBLE_EQ(h.volume_until(1e9), 270);
  EXPECT_EQ(h.peak(), 8);
}

TEST(Hydrograph, knows_when_nothing_enters) {
  using Spells = std::vector<std::pair<double, double>>;
  EXPECT_EQ(Hydrograph({0, 10, 20, 30, 40}, {0, 5, 0, 0, 3}).spells(), (Spells{{0, 20}, {30, 40}}));
  // A discharge of zero for a moment alone ends a spell too.
  EXPECT_EQ(Hydrograph({0, 10, 20}, {5, 0, 5}).spells(), (Spells{{0, 10}, {10, 20}}));
  EXPECT_EQ(Hydrograph({0, 60}, {5, 5}).spells(), (Spells{{0, 60}}));
  EXPECT_TRUE(Hydrograph({0, 60}, {0, 0}).spells().empty());
}

TEST(Hydrograph, is_read_from_a_table_of_any_order_of_columns_and_scaled) {
  const Scratch scratch;
  InflowOptions o;
  o.file = scratch.write("q.csv",
                         "# gauge above the village\ndepth_m; time_s; discharge_m3_s\n1;0;0\n2;10;+8e0\n\n0;20;0\n");
  o.scale = 1.5;
  EXPECT_DOUBLE_EQ(read_hydrograph(o, "here").volume_until(20), 120);
  o.file.clear();
  o.hydrograph = {{0, 2}, {10, 2}};
  EXPECT_DOUBLE_EQ(read_hydrograph(o, "here").volume_until(20), 30);
}

TEST(Hydrograph, refuses_tables_that_are_none_with_line_and_number) {
  const auto fault = [](const std::string& text) {
    const Scratch scratch;
    InflowOptions o;
    o.file = scratch.write("q.csv", text);
    return fault_of<DataError>([&] { read_hydrograph(o, "here"); });
  };
  const std::string head = "time_s,discharge_m3_s\n";
  EXPECT_NE(fault(head + "0,1\n10,2\n5,1\n").find("line 4: time_s = 5 after 10"), std::string::npos);
  EXPECT_NE(fault(head + "0,1\n0,2\n").find("line 3: time_s = 0 after 0"), std::string::npos);
  EXPECT_NE(fault(head + "0,1\n10,-2\n").find("line 3: discharge_m3_s = -2"), std::string::npos);
  EXPECT_NE(fault(head + "-5,1\n10,2\n").find("line 2: time_s = -5"), std::string::npos);
  EXPECT_NE(fault(head + "0,1\n10\n").find("line 3: 1 words"), std::string::npos);
  EXPECT_NE(fault(head + "0,1\n10,nan\n").find("\"nan\""), std::string::npos);
  EXPECT_NE(fault(head + "0,1\n").find("1 rows"), std::string::npos);
  EXPECT_NE(fault("time_s,q\n0,1\n").find("discharge_m3_s"), std::string::npos);
  EXPECT_NE(fault("").find("0 rows"), std::string::npos);
  InflowOptions missing;
  missing.file = "/nowhere/q.csv";
  EXPECT_NE(fault_of<DataError>([&] { read_hydrograph(missing, "here"); }).find("cannot be opened"), std::string::npos);
}

}  // namespace
}  // namespace talus::solver::testing
