// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material/law_list.hpp"

#include <gtest/gtest.h>

namespace talus::testing {
namespace {

struct First {
  static constexpr std::string_view name = "first";
  static constexpr int number = 1;
};
struct Second {
  static constexpr std::string_view name = "second";
  static constexpr int number = 2;
};
using Both = LawList<First, Second>;

TEST(LawLists, know_the_place_of_each_law) {
  EXPECT_EQ(Both::count, 2);
  EXPECT_EQ(Both::index_of<First>(), 0);
  EXPECT_EQ(Both::index_of<Second>(), 1);
  EXPECT_EQ(Both::names(), (std::vector<std::string_view>{"first", "second"}));
}

TEST(LawLists, show_the_law_of_a_number_and_all_laws_in_order) {
  for (int index = 0; index < Both::count; ++index) {
    EXPECT_EQ(visit_law(Both{}, index, [](auto law) { return law.number; }), index + 1);
  }
  std::string all;
  Both::each([&](auto law) { all += law.name; });
  EXPECT_EQ(all, "firstsecond");
}

}  // namespace
}  // namespace talus::testing
