// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as members.h5, sealed by whoever changed them: read, or refused in words.
#include <algorithm>

#include "common/ensemble/member_table.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(members) {
  const talus::fuzz::InputFile file(bytes, ".h5");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    const talus::MemberTable table = talus::read_member_table(file.path());
    for (std::int64_t member = 0; member < std::min<std::int64_t>(table.count, 8); ++member) {
      table.values_of(member, "");
      table.name_of(member);
    }
  });
}
