// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Findings go to the lists of their thread, and refusals end a stage unless the recipe overrides them by name.
#include "tests/common/findings.hpp"

#include <cmath>

#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::findings_of;

const Fault uphill{"after.tif: 9 m3 rose", "mass goes down", "Swap them"};
void find_uphill() { refuse_unless_accepted("swapped-surveys", uphill, {{"rise", 9, "m3"}}); }

TEST(Findings, refuse_with_the_key_that_overrides_it) {
  EXPECT_EQ(test::fault_of<DataError>([] { findings_of(find_uphill, {"false-lengths"}, "preprocess"); }),
            "after.tif: 9 m3 rose (mass goes down). Swap them. To insist on it: accept = [\"swapped-surveys\"] in "
            "[preprocess]");
  EXPECT_THROW(find_uphill(), DataError) << "at once where no stage collects";
}

TEST(Findings, keep_what_is_overridden_once) {
  const auto found = findings_of([] { find_uphill(), find_uphill(); }, {"swapped-surveys"}, "preprocess");
  const Finding expected{Severity::refusal,   "swapped-surveys", "after.tif: 9 m3 rose (mass goes down)",
                         {{"rise", 9, "m3"}}, "preprocess",      "accept in [preprocess]"};
  EXPECT_EQ(found, std::vector<Finding>{expected});
  EXPECT_EQ(accepted_line(found), "swapped-surveys: after.tif: 9 m3 rose (mass goes down)");
}

TEST(Findings, refuse_all_at_once_before_the_fault_that_came_meanwhile) {
  const std::string all = test::fault_of<DataError>([] {
    findings_of([] {
      find_uphill();
      refuse_unless_accepted("steep-ground", {"after.tif: steep", "feet", "Say so"});
      throw DataError({"nothing fell", "", ""});
    });
  });
  EXPECT_LT(all.find("accept = [\"swapped-surveys\"]"), all.find("accept = [\"steep-ground\"]")) << all;
  EXPECT_LT(all.find("accept = [\"steep-ground\"]"), all.find("nothing fell")) << all;
}

TEST(Findings, go_from_the_innermost_list_to_the_first_that_keeps_them_back) {
  testing::internal::CaptureStderr();
  const Findings stage("solve");
  warn("a", "said");
  {
    const Findings aside("solve", {}, Findings::Log::kept_back);
    const Findings inner("solve");
    warn("b", "kept");
    log_info("kept too");
    EXPECT_EQ(inner.list().size(), 1u);
    EXPECT_EQ(aside.list(), inner.list());
    EXPECT_EQ(findings_so_far(), aside.list());
  }
  advise("c", "said as well");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: said\nadvice: said as well\n");
  ASSERT_EQ(stage.list().size(), 2u);
  EXPECT_EQ(stage.list()[1].stage, "solve");
}

TEST(Findings, of_a_stage_before_are_added_as_they_are_and_one_of_them_said) {
  const std::vector<Finding> before{
      test::finding(Severity::advice, "a", "advice"), test::finding(Severity::warning, "b", "coarse"),
      test::finding(Severity::warning, "d", "said before"), test::finding(Severity::refusal, "c", "accepted before")};
  testing::internal::CaptureStderr();
  const Findings stage("solve");
  add_findings(before, "b");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: coarse\n");
  EXPECT_EQ(stage.list(), before);
}

TEST(Findings, name_what_is_accepted_for_nothing) {
  const auto unused = findings_of([] {
    warn_of_unused("preprocess", {"swapped-surveys", "false-lengths"},
                   {test::finding(Severity::refusal, "swapped-surveys", ""),
                    test::finding(Severity::warning, "false-lengths", "only a warning")});
  });
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_TRUE(test::holds(unused[0].message, {"[preprocess]: accept = [\"false-lengths\"]"}));
}

TEST(Findings, are_read_back_from_json_as_they_were) {
  Finding full{Severity::refusal,  "a", "words \"quoted\"", {{"x", 0.1, "m"}, {"y", 2, "1"}}, "solve",
               "accept in [solve]"};
  full.member = 7;
  const std::vector<Finding> all{full, test::finding(Severity::advice, "b", "")};
  EXPECT_EQ(findings_in(to_json(all)), all);
  full.numbers[0].value = std::nan("");
  EXPECT_TRUE(std::isnan(findings_in(to_json({full}))->at(0).numbers[0].value));
  for (const char* text : {"", "{}", "[1]", "[{\"severity\": \"odd\"}]", "[{\"severity\": \"advice\"}]"})
    EXPECT_FALSE(findings_in(text)) << text;
}

}  // namespace
}  // namespace talus
