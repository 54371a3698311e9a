// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers of tables in text files.
#include "solver/scene/table_words.hpp"

#include <gtest/gtest.h>

#include "solver/scene/place_in_cells.hpp"

namespace talus::solver::testing {
namespace {

TEST(TableWords, are_parted_by_any_separator_and_lose_case_quotes_and_comments) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(words_of("Time_s;\"East\", north\tup # g\r"), (Words{"time_s", "east", "north", "up"}));
  EXPECT_TRUE(words_of("  # nothing").empty());
}

TEST(TableWords, are_numbers_where_they_are_finite_ones) {
  EXPECT_EQ(number_in("+1.5e3"), 1500);
  EXPECT_EQ(number_in("-2"), -2);
  for (const char* word : {"", "1,5", "nan", "inf", "1e999", "two", "1x"}) EXPECT_FALSE(number_in(word)) << word;
}

TEST(PlaceInCells, is_the_nearest_node_and_what_is_left) {
  int cell = 0;
  double offset = 0;
  place_in_cells(4.75, cell, offset);
  EXPECT_EQ(cell, 5);
  EXPECT_EQ(offset, -0.25);
  place_in_cells(4.5, cell, offset);
  EXPECT_EQ(cell, 5);
  EXPECT_EQ(offset, -0.5);
}

}  // namespace
}  // namespace talus::solver::testing
