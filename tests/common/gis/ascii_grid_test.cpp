// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One small grid in every dialect that is met in the wild; each must read as the same raster, to the bit.
#include <cstdlib>

#include "common/gis/ascii_grid.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::epsg;
using test::holds;
using test::identical;
using test::Scratch;
using test::small_raster;

const std::string usual = "ncols 3\nnrows 2\nxllcorner 500010\nyllcorner 20\ncellsize 5\nNODATA_value -9999\n";
const std::string cells = "1234.56789 2.25 3\n4 -9999 6\n";

Raster expected() { return small_raster({3, 2, 500010, 20, 5, ""}, {4, std::nan(""), 6, 1234.56789, 2.25, 3}); }

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}
std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  return text;
}

struct Dialect {
  const char* name;
  std::string text;
};
std::ostream& operator<<(std::ostream& out, const Dialect& dialect) { return out << dialect.name; }

struct Dialects : testing::TestWithParam<Dialect> {
  Scratch scratch;
};

TEST_P(Dialects, read_as_one_raster) {
  const auto file = scratch.write("dem.asc", GetParam().text);
  const Raster raster = read_raster(file);
  EXPECT_TRUE(identical(raster, expected())) << "west " << raster.grid.west << ", south " << raster.grid.south
                                             << ", values " << testing::PrintToString(raster.values);
  EXPECT_EQ(scratch.files(), 1u);
}

const std::string centred =
    with(with(usual, "xllcorner 500010", "xllcenter 500012.5"), "yllcorner 20", "yllcenter 22.5");

// GDAL 3.6 reads right: usual to nodata_nan. It refuses: nodata_first to other_words. It misreads without a word: those
// after, which it would put at 0, 0, or whose cells without value would be 0 m or -9999 m high.
INSTANTIATE_TEST_SUITE_P(
    Every, Dialects,
    testing::Values(
        Dialect{"usual", usual + cells}, Dialect{"centre_of_cells", centred + cells},
        Dialect{"upper_case", upper(usual) + cells},
        Dialect{"mixed_case",
                "NCols 3\nNRows 2\nXLLCorner 500010\nYllCorner 20\nCellSize 5\nnodata_Value -9999\n" + cells},
        Dialect{"other_order",
                "nrows 2\nncols 3\nyllcorner 20\nxllcorner 500010\nnodata_value -9999\ncellsize 5\n" + cells},
        Dialect{"cell_size_first",
                "cellsize 5\nyllcorner 20\nxllcorner 500010\nnrows 2\nncols 3\nnodata_value -9999\n" + cells},
        Dialect{"tabs", with(usual + cells, " ", "\t")}, Dialect{"several_blanks", with(usual + cells, " ", "     ")},
        Dialect{"windows_lines", with(usual + cells, "\n", "\r\n")},
        Dialect{"old_mac_lines", with(usual + cells, "\n", "\r")},
        Dialect{"decimal_commas", with(centred + cells, ".", ",")},
        Dialect{"steps_by_axis", with(usual, "cellsize 5", "dx 5\ndy 5") + cells},
        Dialect{"two_cell_sizes", with(usual, "cellsize 5", "cellsize 5 5") + cells},
        Dialect{"exponents", with(usual, "500010", "5.0001e5") + with(cells, "2.25", "+2.25E+00")},
        Dialect{"one_cell_a_line", usual + with(cells, " ", "\n")},
        Dialect{"all_cells_in_one_line", usual + with(cells, "\n", " ")},
        Dialect{"no_end_of_line", usual + cells.substr(0, cells.size() - 1)},
        Dialect{"empty_lines", usual + "\n" + cells + "\n\n"},
        Dialect{"nodata_with_point", with(usual, "-9999", "-9999.0") + with(cells, "-9999", "-9999.000")},
        Dialect{"nodata_1e30", with(usual + cells, "-9999", "1e30")},
        Dialect{"nodata_largest_single", with(usual + cells, "-9999", "-3.4028234663852886e+38")},
        Dialect{"nodata_missing", with(usual, "NODATA_value -9999\n", "") + cells},
        Dialect{"nodata_missing_beside_nan", with(usual, "NODATA_value -9999\n", "") + with(cells, "-9999", "nan")},
        Dialect{"nodata_declared_otherwise",
                with(usual, "-9999", "-1") + with(cells, "-9999", "-3.4028234663852886e+38")},
        Dialect{"nodata_nan", with(usual + cells, "-9999", "NaN")},
        // refused
        Dialect{"nodata_first", "NODATA_value -9999\n" + with(usual, "NODATA_value -9999\n", "") + cells},
        Dialect{"leading_blanks", "  " + with(usual, "\n", "\n  ") + cells},
        Dialect{"byte_order_mark", "\xEF\xBB\xBF" + usual + cells}, Dialect{"comment", "# by hand\n" + usual + cells},
        Dialect{"empty_line_first", "\n" + usual + cells}, Dialect{"colons", with(usual, " ", ": ") + cells},
        Dialect{"equals_signs", with(usual, " ", " = ") + cells},
        Dialect{"french_keys", with(with(usual, "ncols", "nbcols"), "nrows", "nbrows") + cells},
        Dialect{"cells_parted_by_commas", usual + with(cells, " ", ",")},
        Dialect{"cells_parted_by_commas_and_blanks", usual + with(cells, " ", ", ")},
        Dialect{"cells_parted_by_semicolons", usual + with(cells, " ", ";")},
        // misread
        Dialect{"british_centre", with(centred, "center", "centre") + cells},
        Dialect{"corner_and_centre", with(usual, "xllcorner 500010", "xllcenter 500012.5") + cells},
        Dialect{"from_the_north", with(with(usual, "xllcorner", "xulcorner"), "yllcorner 20", "yulcorner 30") + cells},
        Dialect{"fortran_exponents", with(usual, "500010", "5.0001D5") + with(cells, "2.25", "0.225D+01")},
        Dialect{"nodata_by_another_key", with(usual, "NODATA_value", "nodata") + cells},
        Dialect{"nodata_missing_beside_words", with(usual, "NODATA_value -9999\n", "") + with(cells, "-9999", "*")},
        Dialect{"nodata_star", usual + with(cells, "-9999", "*")},
        Dialect{"nodata_word", usual + with(cells, "-9999", "NA")},
        Dialect{"nodata_dash", usual + with(cells, "-9999", "-")},
        Dialect{"nodata_of_microsoft", with(usual + cells, "-9999", "-1.#IND")}),
    [](const auto& dialect) { return std::string(dialect.param.name); });

using AsciiGrid = test::InScratch;

TEST_F(AsciiGrid, has_its_crs_in_a_file_beside) {
  scratch.write("dem.asc", usual + cells);
  scratch.write("odd.asc", "# by hand\n" + usual + cells);
  scratch.write("words.asc", usual + with(cells, "-9999", "*"));
  const std::string command =
      "cd " + scratch.folder().string() +
      " && gdalsrsinfo -o wkt_esri EPSG:32611 | sed /^$/d > dem.prj && cp dem.prj odd.prj && cp dem.prj words.PRJ";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* name : {"dem.asc", "odd.asc", "words.asc"})
    EXPECT_TRUE(same_crs(RasterFile(scratch / name).grid().crs_wkt, epsg(32611))) << name;
}

TEST_F(AsciiGrid, with_a_word_that_is_no_number_or_cut_short_is_a_fault) {
  const auto file = scratch.write("dem.asc", usual + "1 2 3\n4 fie 6\n");
  EXPECT_EQ(data_fault([&] { read_raster(file); }),
            "./dem.asc: line 8, column 3: \"fie\" (a cell of an ASCII grid is a number). Mend the line; cells without "
            "value hold "
            "the NODATA_value of the header, or *");
  const auto brief = scratch.write("brief.asc", "# comment\n" + usual + "1 2 3\n4\n");
  EXPECT_TRUE(test::begins(data_fault([&] { read_raster(brief); }), "./brief.asc: its cells cannot be read ("));
}

TEST_F(AsciiGrid, whose_thousands_a_sign_parts_is_refused_by_its_place) {
  const auto fault = [&](const std::string& body) {
    const auto file = scratch.write("dem.asc", usual + body);
    return data_fault([&] { read_raster(file); });
  };
  for (const char* apostrophe : {"1 2 1'234.5\n4 5 6\n", "1 2 1\u2019234\n4 5 6\n"})
    EXPECT_TRUE(holds(fault(apostrophe), {"./dem.asc: line 7, column 5: \"1", "thousands"})) << apostrophe;
  for (const char* blank : {"1 2 1 234.5\n4 5 6\n", "1 2 1 234,5\n4 5 6\n"})
    EXPECT_TRUE(holds(fault(blank), {"./dem.asc: line 7, column 7: \"234", "are 7", "thousands"})) << blank;
  EXPECT_TRUE(holds(fault("1 2 3\n4 5 1,234.5\n"), {"./dem.asc: line 8, column 5: \"1,234.5\"", "are 7"}));
  EXPECT_TRUE(holds(fault("1 2 1,234\n4 5 6\n"), {"line 7, column 5: \"1,234\"", "1.234, or 1234"}));
  EXPECT_TRUE(holds(fault("1,5 2 3\n4.5 5 6\n"), {"line 8, column 1: \"4.5\"", "decimal commas and decimal points"}));
  EXPECT_EQ(fault("1,234 2,5 3\n4 5 6\n"), "") << "the other number tells";
  EXPECT_EQ(fault("1\n2 3 4 5\n6\n"), "") << "on any lines";
}

TEST_F(AsciiGrid, in_utf16_is_refused_with_the_command) {
  const auto file = scratch.write("dem.asc", std::string("\xff\xfen\0c\0", 6));
  EXPECT_TRUE(holds(data_fault([&] { read_raster(file); }),
                    {"./dem.asc: its text is UTF-16", "iconv -f UTF-16 -t UTF-8 ./dem.asc > ./dem-utf8.asc"}));
}

// Heights of 0 to 255 m as integers of two bytes are zeros and other bytes in turn, and -2 m is the mark of UTF-16.
TEST_F(AsciiGrid, is_not_told_from_low_heights_in_binary) {
  scratch.write("dem.hdr",
                "NROWS 40\nNCOLS 50\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER I\nULXMAP 2.5\nULYMAP 197.5\nXDIM 5\n"
                "YDIM 5\n");
  std::string cells(2 * 40 * 50, '\0');
  for (std::size_t n = 0; n < 40 * 50; ++n) cells[2 * n] = static_cast<char>(n % 240);
  EXPECT_DOUBLE_EQ(read_raster(scratch.write("dem.bil", cells)).at(5, 39), 5);
  cells[0] = static_cast<char>(0xFE);
  cells[1] = static_cast<char>(0xFF);
  EXPECT_DOUBLE_EQ(read_raster(scratch.write("dem.bil", cells)).at(0, 39), -2);
}

TEST_F(AsciiGrid, windows_of_one_with_an_odd_header_equal_the_whole) {
  std::string text = "# odd\n" + with(with(usual, "ncols 3", "ncols 50"), "nrows 2", "nrows 40");
  for (int i = 0; i < 2000; ++i) text += std::to_string(0.37 * i) + (i % 50 == 49 ? "\n" : " ");
  const RasterFile file(scratch.write("dem.asc", text));
  const Raster whole = file.read();
  EXPECT_DOUBLE_EQ(whole.at(0, 39), 0);
  EXPECT_NEAR(whole.at(49, 0), 0.37 * 1999, 1e-6);
  EXPECT_EQ(file.read({10, 20, 7, 5}).values, cut(whole, {10, 20, 7, 5}).values);
}

TEST_F(AsciiGrid, text_that_is_none_has_no_header) {
  EXPECT_FALSE(ascii_header("x,y,z\n1,2,3\n"));
  EXPECT_FALSE(ascii_header("north: 30\nsouth: 20\neast: 25\nwest: 10\nrows: 2\ncols: 3\n1 2 3\n4 5 6\n"));  // GRASS
  EXPECT_FALSE(ascii_header(""));
  EXPECT_TRUE(ascii_header(usual + cells)->usual);
}

TEST(EscapedXml, marks_up_nothing_keeps_other_text_and_leaves_control_characters_out) {
  EXPECT_EQ(escaped_xml("a <b> & \"c\""), "a &lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escaped_xml("</script><!--"), "&lt;/script&gt;&lt;!--");
  EXPECT_EQ(escaped_xml(""), "");
  EXPECT_EQ(escaped_xml("Rüfe, 15° 'x'"), "Rüfe, 15° 'x'");
  EXPECT_EQ(escaped_xml("a\x01"
                        "b\tc"),
            "ab\tc");
}

}  // namespace
}  // namespace talus
