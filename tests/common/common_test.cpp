// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "common/whole_text.hpp"
#include "tests/common/scratch.hpp"

namespace talus {

TEST(Error, text_has_what_why_and_mend_and_kinds_their_exit_codes_and_all_faults) {
  EXPECT_EQ(to_string({"a.tif: CRS is EPSG:4326", "this stage needs metres", "Reproject: gdalwarp"}),
            "a.tif: CRS is EPSG:4326 (this stage needs metres). Reproject: gdalwarp");
  EXPECT_EQ(to_string({"a.tif: no such file", "", "Check the path"}), "a.tif: no such file. Check the path");
  EXPECT_EQ(to_string({"a.tif: no such file", "", ""}), "a.tif: no such file");
  EXPECT_EQ(static_cast<int>(RecipeError(Fault{}).code()), 2);
  EXPECT_EQ(static_cast<int>(DataError(Fault{}).code()), 3);
  EXPECT_EQ(static_cast<int>(NumericalError(Fault{}).code()), 4);
  EXPECT_EQ(static_cast<int>(Interrupted(Fault{}).code()), 130);
  const RecipeError two({Fault{"first", "", ""}, Fault{"second", "why", ""}});
  EXPECT_EQ(two.faults().size(), 2u);
  EXPECT_STREQ(two.what(), "first\nsecond (why)");
}

namespace {

TEST(WholeText, without_end_is_given_up) {
  const auto refuse = [](const std::string& reason) { throw DataError({"text", reason, "mend"}); };
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { whole_text("/dev/zero", 1 << 20, refuse); }),
                          {"it is longer than 1 MB"}));
}

}  // namespace
}  // namespace talus
