// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/make_rules.hpp"

#include <gtest/gtest.h>

namespace talus::command {
namespace {

TEST(MakeRules, are_read_back_as_they_were_made) {
  const Dependencies made{{"out/domain.vdb", "out/obstacles.vdb"},
                          {"before.tif", "with space.tif", "a:b.tif", "50%.tif", "cost$.tif", "a=b.tif", "#1.tif",
                           "back\\slash.tif", "back\\ space.tif", "two\\\\ more.tif", "what?[x]*|.tif", "\u00fc.tif"}};
  const Dependencies read = read_make_rules(make_rules(made));
  EXPECT_EQ(read.results, made.results);
  EXPECT_EQ(read.inputs, made.inputs);
}

TEST(MakeRules, of_a_stage_that_reads_nothing_have_no_inputs) {
  const Dependencies read = read_make_rules(make_rules({{"out/domain.vdb"}, {}}));
  EXPECT_EQ(read.results, std::vector<std::filesystem::path>{"out/domain.vdb"});
  EXPECT_TRUE(read.inputs.empty());
}

TEST(MakeRules, names_that_make_cannot_write_are_left_out) {
  const Dependencies read = read_make_rules(make_rules({{"out/domain.vdb"}, {"a;b.tif", "c.tif"}}));
  EXPECT_EQ(read.results.size(), 1u);
  EXPECT_EQ(read.inputs, std::vector<std::filesystem::path>{"c.tif"});
}

}  // namespace
}  // namespace talus::command
