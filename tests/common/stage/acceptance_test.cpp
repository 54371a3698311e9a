// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is implausible is refused unless it is accepted by name.
#include "common/stage/acceptance.hpp"

#include <gtest/gtest.h>

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

const Implausible uphill{"swapped-surveys", {"after.tif: 9 m3 rose", "mass goes down", "Swap them"}};

TEST(acceptance, refuses_with_the_key_by_which_to_insist) {
  Acceptance none("preprocess", {"false-lengths"});
  EXPECT_EQ(test::fault_of<DataError>([&] { none.judge(uphill); }),
            "after.tif: 9 m3 rose (mass goes down). Swap them. To insist on it: accept = [\"swapped-surveys\"] in "
            "[preprocess]");
  EXPECT_TRUE(none.facts().empty());
}

TEST(acceptance, keeps_what_was_insisted_on_once) {
  Acceptance insisted("preprocess", {"swapped-surveys"});
  insisted.judge(uphill);
  insisted.judge(uphill);
  ASSERT_EQ(insisted.facts().size(), 1u);
  const auto accepted = accepted_in({{"scene", "x"}, insisted.facts()[0]});
  ASSERT_EQ(accepted.size(), 1u);
  EXPECT_EQ(accepted[0].first, "swapped-surveys");
  EXPECT_EQ(accepted[0].second, "after.tif: 9 m3 rose (mass goes down)");
}

TEST(acceptance, says_all_that_it_refuses_at_once_where_it_collects) {
  const Implausible steep{"steep-ground", {"after.tif: steep", "feet", "Say so"}};
  Acceptance none("preprocess", {});
  none.collect();
  none.judge(uphill);
  none.judge(steep);
  const std::string all = test::fault_of<DataError>([&] { none.settle(); });
  EXPECT_NE(all.find("accept = [\"swapped-surveys\"]"), std::string::npos) << all;
  EXPECT_NE(all.find("accept = [\"steep-ground\"]"), std::string::npos) << all;
  EXPECT_NO_THROW(none.settle()) << "said once";
}

TEST(acceptance, what_was_refused_stands_before_the_fault_that_came_meanwhile) {
  Acceptance none("preprocess", {});
  none.collect();
  none.judge(uphill);
  const std::string all = test::fault_of<DataError>([&] {
    none.meanwhile([] { throw DataError({"nothing fell", "", ""}); });
  });
  EXPECT_LT(all.find("swapped-surveys"), all.find("nothing fell")) << all;
}

TEST(acceptance, warns_of_a_name_that_nothing_met) {
  Acceptance insisted("preprocess", {"swapped-surveys", "false-lengths"});
  insisted.judge(uphill);
  testing::internal::CaptureStderr();
  insisted.warn_of_unmet();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("accept = [\"false-lengths\"]"), std::string::npos) << said;
  EXPECT_EQ(said.find("swapped-surveys"), std::string::npos) << said;
  testing::internal::CaptureStderr();
  insisted.warn_of_unmet({{accepted_fact("false-lengths"), "of another run"}});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace talus
