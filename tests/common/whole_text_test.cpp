// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is read as one text.
#include "common/whole_text.hpp"

#include <gtest/gtest.h>

#include <string>

#include "common/error.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

TEST(WholeText, without_end_is_given_up) {
  const auto refuse = [](const std::string& reason) { throw DataError({"text", reason, "mend"}); };
  const std::string fault = test::fault_of<DataError>([&] { whole_text("/dev/zero", 1 << 20, refuse); });
  EXPECT_NE(fault.find("it is longer than 1 MB"), std::string::npos) << fault;
}

}  // namespace
}  // namespace talus
