// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/output/provenance.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/common/scratch.hpp"

namespace talus::preprocess {
namespace {

TEST(Inputs, that_are_as_they_were_pass) {
  const test::Scratch scratch;
  const Facts inputs = checksums_of({scratch.write("before.asc", "one"), scratch.write("after.asc", "two")});
  EXPECT_NO_THROW(require_unchanged(inputs));
}

TEST(Inputs, that_changed_are_refused_by_name) {
  const test::Scratch scratch;
  const Facts inputs = checksums_of({scratch.write("before.asc", "one"), scratch.write("after.asc", "two")});
  scratch.write("after.asc", "three");
  const std::string fault = test::fault_of<DataError>([&] { require_unchanged(inputs); });
  EXPECT_NE(fault.find("after.asc: it is not what it was"), std::string::npos) << fault;
}

TEST(Inputs, that_are_gone_are_refused) {
  const test::Scratch scratch;
  const Facts inputs = checksums_of({scratch.write("before.asc", "one")});
  std::filesystem::remove(scratch / "before.asc");
  EXPECT_THROW(require_unchanged(inputs), DataError);
}

}  // namespace
}  // namespace talus::preprocess
