// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/member_table.hpp"

#include <gtest/gtest.h>

#include "common/ensemble/member_words.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"

namespace talus {
namespace {

TEST(MemberTable, comes_back_as_it_was_written) {
  const test::Scratch scratch;
  MemberTable table = test::ensemble_table(6);
  table.own_domain = {0, 1, 1, 0, 1, 0};
  table.failures = {{1, "the source is empty: threshold_m = 90"}, {4, "two\nlines"}};
  table.provenance = {{recipe_of_members, "aabb"}};
  write_member_table(scratch / "members.h5", table);
  const MemberTable read = read_member_table(scratch / "members.h5");
  EXPECT_EQ(read.design, table.design);
  EXPECT_EQ(read.count, 6);
  ASSERT_EQ(read.columns.size(), table.columns.size());
  for (std::int64_t k = 0; k < 6; ++k) EXPECT_EQ(read.values_of(k, ""), table.values_of(k, ""));
  EXPECT_EQ(read.own_domain, table.own_domain);
  EXPECT_EQ(read.failures, table.failures);
  EXPECT_EQ(read.provenance, table.provenance);
}

TEST(MemberTable, tells_why_a_member_has_no_domain) {
  MemberTable table = test::ensemble_table(6);
  table.failures = {{4, "the source is empty"}};
  EXPECT_EQ(table.failure_of(3), nullptr);
  ASSERT_NE(table.failure_of(4), nullptr);
  EXPECT_EQ(table.failure_of(4)->words, "the source is empty");
}

TEST(MemberTable, with_a_failure_of_no_member_is_refused) {
  const test::Scratch scratch;
  MemberTable table = test::ensemble_table(6);
  for (const std::int64_t member : {std::int64_t{-1}, std::int64_t{6}}) {
    table.failures = {{member, "the source is empty"}};
    write_member_table(scratch / "members.h5", table);
    const std::string fault = test::fault_of<DataError>([&] { read_member_table(scratch / "members.h5"); });
    EXPECT_NE(fault.find("group /failures names member " + std::to_string(member)), std::string::npos) << fault;
  }
}

}  // namespace
}  // namespace talus
