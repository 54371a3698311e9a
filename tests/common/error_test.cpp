// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/error.hpp"

#include <gtest/gtest.h>

namespace talus {

TEST(Error, text_has_what_why_and_mend) {
  EXPECT_EQ(to_string({"a.tif: CRS is EPSG:4326", "this stage needs metres", "Reproject: gdalwarp"}),
            "a.tif: CRS is EPSG:4326 (this stage needs metres). Reproject: gdalwarp");
  EXPECT_EQ(to_string({"a.tif: no such file", "", "Check the path"}), "a.tif: no such file. Check the path");
  EXPECT_EQ(to_string({"a.tif: no such file", "", ""}), "a.tif: no such file");
}

TEST(Error, kinds_carry_their_exit_codes_and_all_faults) {
  EXPECT_EQ(static_cast<int>(RecipeError(Fault{}).code()), 2);
  EXPECT_EQ(static_cast<int>(DataError(Fault{}).code()), 3);
  EXPECT_EQ(static_cast<int>(NumericalError(Fault{}).code()), 4);
  EXPECT_EQ(static_cast<int>(Interrupted(Fault{}).code()), 130);
  const RecipeError two({Fault{"first", "", ""}, Fault{"second", "why", ""}});
  EXPECT_EQ(two.faults().size(), 2u);
  EXPECT_STREQ(two.what(), "first\nsecond (why)");
}

}  // namespace talus
