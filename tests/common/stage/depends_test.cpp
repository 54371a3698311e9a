// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/depends.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(MakeRules, lists_every_input_once_and_gives_each_an_empty_rule) {
  EXPECT_EQ(make_rules({{"out/domain.vdb", "out/obstacles.vdb"}, {"/a/b.tif", "/c.tif", "/a/b.tif", ""}}),
            "out/domain.vdb out/obstacles.vdb: \\\n  /a/b.tif \\\n  /c.tif\n\n/a/b.tif:\n\n/c.tif:\n");
}

TEST(MakeRules, a_result_of_no_file_is_a_rule_as_well) { EXPECT_EQ(make_rules({{"a"}, {}}), "a:\n"); }

TEST(MakeRules, escapes_what_make_would_take_for_something_else) {
  const auto in_and_out = [](const std::string& name) {
    const std::string rules = make_rules({{"r"}, {name}});
    const auto at = rules.find("\n\n");
    return std::pair{rules.substr(7, at - 7), rules.substr(at + 2, rules.size() - at - 4)};
  };
  const auto same = [](const std::string& text) { return std::pair{text, text}; };
  EXPECT_EQ(in_and_out("Höhen vor.tif"), same("Höhen\\ vor.tif"));
  EXPECT_EQ(in_and_out("a#b"), same("a\\#b"));
  EXPECT_EQ(in_and_out("a$b"), same("a$$b"));
  EXPECT_EQ(in_and_out("C:b"), same("C\\:b"));
  EXPECT_EQ(in_and_out("a|b"), same("a\\|b"));
  EXPECT_EQ(in_and_out("a[1]*?"), same("a\\[1]\\*\\?"));
  EXPECT_EQ(in_and_out("a=b"), same("a$(or =)b"));
  EXPECT_EQ(in_and_out("a%b"), std::pair(std::string("a%b"), std::string("a\\%b")));
  EXPECT_EQ(in_and_out("a\\b"), same("a\\b"));
  EXPECT_EQ(in_and_out("a\\\\ b"), same("a\\\\\\\\\\ b"));
}

TEST(MakeRules, says_which_names_make_cannot_read) {
  for (const char* name : {"a;b", "a(1)", "a&", "a\\"})
    EXPECT_EQ(make_rules({{"r"}, {name, "c"}}),
              std::string("# left out, for make has no way to write this name: ") + name + " .\nr: \\\n  c\n\nc:\n");
  EXPECT_EQ(make_rules({{"r"}, {"a\nb"}}), "# left out, for make has no way to write this name: a b .\nr:\n");
}

}  // namespace
}  // namespace talus
