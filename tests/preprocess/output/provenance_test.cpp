// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/output/provenance.hpp"

#include "tests/common/scratch.hpp"

namespace talus::preprocess {
namespace {

using Inputs = test::InScratch;

TEST_F(Inputs, that_changed_or_are_gone_are_refused_by_name) {
  const Facts inputs = checksums_of({scratch.write("before.asc", "one"), scratch.write("after.asc", "two")});
  EXPECT_NO_THROW(require_unchanged(inputs));
  scratch.write("after.asc", "three");
  EXPECT_TRUE(test::holds(data_fault([&] { require_unchanged(inputs); }), {"./after.asc: it is not what it was"}));
  std::filesystem::remove(scratch / "before.asc");
  EXPECT_THROW(require_unchanged({inputs.front()}), DataError);
}

}  // namespace
}  // namespace talus::preprocess
