// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerograms and the words of tables of text.
#include "solver/scene/tables.hpp"
#include "common/table_words.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"

namespace talus::solver::testing {
namespace {

/// The options that name a file of this text.
struct ShakingFile {
  test::Scratch scratch;
  ShakingOptions options;
  explicit ShakingFile(const std::string& text) { options.file = scratch.write("record.csv", text); }

  Shaking read() const { return read_shaking(options); }
  /// The refusal, without the folder.
  std::string refusal() const {
    std::string text = test::fault_of<DataError>([&] { read(); });
    const std::string folder = scratch.folder().string() + "/";
    while (text.find(folder) != std::string::npos) text.erase(text.find(folder), folder.size());
    return text;
  }
};

TEST(ReadShaking, takes_columns_by_name_in_any_order) {
  const Shaking shaking = ShakingFile(
                              "# station X, 2026\n"
                              "up, time_s; \"North\"\tEAST\r\n"
                              "0.5, 3.0, -1, +2e0\n"
                              "\n"
                              "0.25, 3.5, 1, 4   # the last one\n")
                              .read();
  ASSERT_EQ(shaking.samples.size(), 2u);
  EXPECT_EQ(shaking.samples[0].time, 0) << "the first row acts at start_s";
  EXPECT_EQ(shaking.samples[1].time, 0.5);
  expect_near(shaking.samples[0].acceleration, {2, -1, 0.5}, 0);
  EXPECT_DOUBLE_EQ(shaking.samples[1].velocity.x, 1.5);
}

TEST(ReadShaking, brings_units_scale_and_start_to_the_run) {
  ShakingFile file("time_s,east\n0,1\n0.1,-1\n");
  file.options.unit = ShakingUnit::g;
  file.options.scale = -0.5;
  file.options.start = 7;
  EXPECT_DOUBLE_EQ(file.read().samples[0].acceleration.x, -0.5 * 9.80665);
  EXPECT_EQ(file.read().samples[0].time, 7);
  EXPECT_DOUBLE_EQ(file.read().samples[1].time, 7.1);
  file.options.unit = ShakingUnit::cm_s2;
  EXPECT_DOUBLE_EQ(file.read().samples[1].acceleration.x, 0.005);
}

TEST(ReadShaking, turns_components_along_an_azimuth_to_the_map) {
  ShakingFile file("time_s along across up\n0 2 3 5\n1 0 0 0\n");
  const auto first = [&](double azimuth) {
    file.options.azimuth = azimuth;
    return file.read().samples[0].acceleration;
  };
  EXPECT_NEAR(first(0).x, 3, 1e-15);  // along points north, across east
  EXPECT_NEAR(first(0).y, 2, 1e-15);
  EXPECT_NEAR(first(90).x, 2, 1e-15);  // along east, across south
  EXPECT_NEAR(first(90).y, -3, 1e-15);
  EXPECT_EQ(first(90).z, 5);
}

TEST(ReadShaking, no_file_is_ground_that_rests) { EXPECT_FALSE(read_shaking({}).acts()); }

TEST(ReadShaking, what_is_no_accelerogram_is_refused_with_its_line) {
  constexpr const char* name_them =
      "Name the columns in the first line: time_s and some of east, north, up; or time_s and some of along, across, "
      "up, "
      "with azimuth_deg in [solve.shaking]";
  const auto refusal = [](const std::string& text) { return ShakingFile(text).refusal(); };
  EXPECT_EQ(refusal("0 1\n1 2\n"),
            std::string("record.csv: line 1, column 1: \"0\" (it is no name of a column). ") + name_them);
  EXPECT_EQ(refusal("time_s east_g\n"),
            std::string("record.csv: line 1, column 8: \"east_g\" (it is no name of a column). ") + name_them);
  EXPECT_EQ(refusal("time_s\n0\n1\n"),
            std::string("record.csv: line 1: no time_s with an acceleration (both are needed). ") + name_them);
  EXPECT_EQ(refusal("time_s up up\n"),
            std::string("record.csv: line 1: two columns \"up\" (only one can act). ") + name_them);
  EXPECT_EQ(refusal("time_s east along\n"),
            std::string("record.csv: line 1: columns along and across beside east and north (they are the same). ") +
                name_them);
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1 2\n"),
            "record.csv: line 3: 3 words (the first line names 2 columns). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 nan\n"),
            "record.csv: line 3, column 5: \"nan\" (it is no finite number). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1e999\n"),
            "record.csv: line 3, column 5: \"1e999\" (it is no finite number). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1\n0.1 2\n"),
            "record.csv: line 4: time_s = 0.1 (times must grow from row to row). Sort the rows, and leave out those of "
            "the same time");
  EXPECT_EQ(refusal("time_s east\n0 1\n"), "record.csv (it has 1 rows of numbers). An accelerogram has two at least");
  EXPECT_EQ(refusal("time_s east\n0 1e308\n10 1e308\n"),
            "record.csv (the velocity of the ground is beyond all numbers). Check its unit and its scale");
}

TEST(ReadShaking, reads_a_table_of_any_locale_or_refuses_the_place) {
  for (const char* text : {"time_s,east\n0,1.5\n1,-2.25\n", "time_s;east\n0;1,5\n1;-2,25\n",
                           "time_s\teast\n0\t1,5\n1\t-2,25\n", "\xEF\xBB\xBFtime_s;east\r\n0;1,5\r\n1;-2,25\r\n"}) {
    const Shaking shaking = ShakingFile(text).read();
    ASSERT_EQ(shaking.samples.size(), 2u) << text;
    EXPECT_EQ(shaking.samples[1].acceleration.x, -2.25) << text;
  }
  const auto refusal = [](const std::string& text) { return ShakingFile(text).refusal(); };
  EXPECT_TRUE(test::holds(refusal("time_s;east\n0;1'234.5\n1;0\n"), {"line 2, column 3: \"1'234.5\"", "thousands"}));
  EXPECT_TRUE(test::holds(refusal("time_s;east\n0;1 234,5\n1;0\n"), {"line 2, column 3: \"1 234,5\"", "thousands"}));
  EXPECT_TRUE(test::holds(refusal("time_s;east\n0;1,234\n1;0\n"), {"line 2, column 3: \"1,234\"", "1.234, or 1234"}));
}

TEST(ReadShaking, an_azimuth_belongs_to_columns_along_it) {
  ShakingFile turned("time_s along\n0 1\n1 0\n");
  EXPECT_EQ(turned.refusal(),
            "record.csv: line 1: columns along or across (it is not said where they point). Give [solve.shaking] "
            "azimuth_deg, the direction of along from north over east");
  ShakingFile mapped("time_s east\n0 1\n1 0\n");
  mapped.options.azimuth = 30;
  EXPECT_EQ(mapped.refusal(),
            "record.csv: line 1: no column along or across (azimuth_deg would have no effect). Leave [solve.shaking] "
            "azimuth_deg out, or name the columns by it");
}

TEST(ReadShaking, a_missing_file_is_named) {
  ShakingFile file("");
  file.options.file = file.scratch / "nothing.csv";
  EXPECT_EQ(file.refusal(), "nothing.csv: cannot be opened (missing or not readable). Check [solve.shaking] file");
}

TEST(TableWords, are_parted_by_any_separator_and_lose_case_quotes_and_comments) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(table_words("Time_s;\"East\", north\tup # g\r"), (Words{"time_s", "east", "north", "up"}));
  EXPECT_TRUE(table_words("  # nothing").empty());
}

TEST(TableWords, have_decimal_commas_where_something_else_parts_them) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(table_words("430;200;8,9"), (Words{"430", "200", "8.9"}));
  EXPECT_EQ(table_words("430,5 200,25\t-8,9e-1"), (Words{"430.5", "200.25", "-8.9e-1"}));
  EXPECT_EQ(table_words("\xEF\xBB\xBFx;y;depth"), (Words{"x", "y", "depth"}));
  EXPECT_EQ(table_words("1,2,3"), (Words{"1", "2", "3"}));
  EXPECT_EQ(table_words("1, 2, 3"), (Words{"1", "2", "3"}));
  EXPECT_EQ(table_words("1,2,3 4"), (Words{"1", "2", "3", "4"}));
  EXPECT_EQ(table_words("1.0,2.0,3.0,by hand"), (Words{"1.0", "2.0", "3.0", "by", "hand"}));
  for (const char* many : {"1;1.234,5", "1;1,234,567"}) EXPECT_FALSE(signed_number(table_words(many).at(1))) << many;
}

TEST(TableWords, are_numbers_where_they_are_finite_ones) {
  EXPECT_EQ(signed_number("+1.5e3"), 1500);
  EXPECT_EQ(signed_number("-2"), -2);
  for (const char* word : {"", "1,5", "nan", "inf", "1e999", "two", "1x"}) EXPECT_FALSE(signed_number(word)) << word;
}

}  // namespace
}  // namespace talus::solver::testing
