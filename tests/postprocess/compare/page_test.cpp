// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a comparison lets in what it brings along and nothing else.
#include "postprocess/compare/compare.hpp"
#include "postprocess/report/filled_page.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

TEST(ComparePage, lets_no_style_in_but_its_own_and_takes_names_as_text) {
  const std::string hostile = "<img src=x onerror=alert(1)>\"'";
  ComparedRun first{.name = hostile, .run = test::small_run(), .score = {}, .used = {}}, second = first;
  first.run.summary.title = hostile;
  for (double& h : second.run.maps.deposit_thickness) h *= 1.5;  // so that there are classes with colours
  const std::string page = comparison_html(first, second, 0.1);
  EXPECT_FALSE(test::holds(page, {"unsafe-"}));
  EXPECT_FALSE(test::holds(page, {"style=\""})) << "no browser that heeds the policy takes it";
  EXPECT_FALSE(test::holds(page, {"<img src=x"}));
  const std::size_t begin = page.find("<style>") + 7, end = page.find("</style>");
  ASSERT_LT(begin, end);
  const std::string style = page.substr(begin, end - begin);
  EXPECT_TRUE(
      test::holds(page, {"style-src " + policy_source(style) + "\"", "<rect width=\"100%\" height=\"100%\" fill=\"#"}));
}

}  // namespace
}  // namespace talus::postprocess
