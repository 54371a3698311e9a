// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include <fmt/format.h>

#include "common/text_encoding.hpp"
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

TEST(Error, numbers_of_many_digits_are_short_and_names_stay) {
  EXPECT_EQ(with_short_numbers(fmt::format("x {:.1f} m, {:.0f} m3", 1e300, -2e100)), "x 1e+300 m, -2e+100 m3");
  EXPECT_EQ(with_short_numbers("1,000,000,000,000,000,000,000 cells, 12,345 m"), "1e+21 cells, 12,345 m");
  for (const std::string same :
       {"sha256 1234567890123456789012345a", "/tmp/12345678901234567890/a", "a_12345678901234567890.tif",
        "0.1234567890123456789", "123456789012345678 m", "1e+300", "400505.0, 5200205.0", "2026-11-28 12:00", ""})
    EXPECT_EQ(with_short_numbers(same), same);
  EXPECT_EQ(to_string({fmt::format("{:f} m", 1e30), "", ""}), "1e+30 m");
}

TEST(Error, of_many_faults_says_the_first_and_counts_the_rest) {
  std::vector<Fault> many(100'000, Fault{"row", "no number", ""});
  many[0].what = "first";
  const DataError error(many);
  EXPECT_EQ(error.faults().size(), 51u);
  EXPECT_EQ(error.faults().front().what, "first");
  EXPECT_EQ(to_string(error.faults().back()), "99950 more faults. Mend those above first");
  EXPECT_LT(std::string(error.what()).size(), 2000u);
}

namespace {

TEST(WholeText, without_end_is_given_up) {
  const auto refuse = [](const std::string& reason) { throw DataError({"text", reason, "mend"}); };
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { whole_text("/dev/zero", 1 << 20, refuse); }),
                          {"it is longer than 1 MB"}));
}

TEST(TextEncoding, takes_what_is_no_utf8_as_cp1252) {
  for (const char* utf8 : {"", "plain", "H\u00f6lle", "\u20ac", "\U0001F3D4", "\u65e5\u672c"}) {
    EXPECT_TRUE(is_utf8(utf8)) << utf8;
    EXPECT_EQ(as_utf8(utf8), utf8);
  }
  for (const char* none : {"H\xf6lle", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80", "\xff"}) {
    EXPECT_FALSE(is_utf8(none)) << none;
    EXPECT_TRUE(is_utf8(as_utf8(none))) << none;
  }
  EXPECT_EQ(as_utf8("H\xf6lle \x80 \x96 \x8a"), "H\u00f6lle \u20ac \u2013 \u0160");
  EXPECT_EQ(as_utf8("\xc2\x80"), "\u20ac") << "declared as ISO 8859-1";
  EXPECT_EQ(as_utf8("\x81"), "\ufffd") << "CP1252 has no such character";
  for (const char* both : {"H\xf6lle \x80 \x96 \x8a", "plain"}) EXPECT_EQ(as_cp1252(as_utf8(both)), both);
  EXPECT_EQ(as_cp1252("\u65e5\ufffd\u0080"), "???");
}

TEST(TextEncoding, knows_wide_text_by_its_mark_or_its_zeros) {
  using namespace std::string_literals;
  EXPECT_EQ(wide_encoding("\xff\xfe"
                          "a\0"s),
            "UTF-16");
  EXPECT_EQ(wide_encoding("\xfe\xff\0a"s), "UTF-16");
  EXPECT_EQ(wide_encoding("\xff\xfe\0\0"s), "UTF-32");
  EXPECT_EQ(wide_encoding("n\0a\0m\0e\0"s), "UTF-16LE");
  EXPECT_EQ(wide_encoding("\0n\0a\0m\0e"s), "UTF-16BE");
  for (const auto& other : {"name,t\n1,2"s, "SQLite format 3\0"s, "\0\0\x27\x0a\0\0\0\0"s,
                            "\0\x41\0\x52\0\x1b\0\x60\0\x07"s, "II*\0\x08\0\0\0"s, ""s, "a\0"s})
    EXPECT_EQ(wide_encoding(other), "") << other;
}

}  // namespace
}  // namespace talus
