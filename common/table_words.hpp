// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables in text files: lines of words between separators, the numbers that they are, and numbers that can be read in
// two ways.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A word of a line.
struct TableWord {
  std::string text;        ///< in lower case, a decimal comma as a point
  std::string written;     ///< as it stands
  std::size_t column = 0;  ///< where it begins, from 1
};

/// The words of a line, without byte order mark, comment (from # on) and quotes; commas, semicolons and blanks part
/// them. Where semicolons or blanks part them without commas, a comma between digits is a decimal point: "430;200;8,9";
/// a number with more than one such sign ("1.234,5") stays a word that is none.
std::vector<TableWord> placed_words(const std::string& line);

/// Their texts.
std::vector<std::string> table_words(const std::string& line);

/// The number that a word is; none where it is no finite one.
std::optional<double> finite_number(std::string_view word);

/// The same of a word that may begin with a +.
std::optional<double> signed_number(std::string_view word);

/// Whether a word is digits with signs between them that group or part them, and no number: "1'234.5", "1.234,5".
bool is_grouped(std::string_view word);

/// A number that can be read in two ways.
struct NumberDoubt {
  int line = 0;
  std::size_t column = 0;
  std::string written, why, mend;
};

/// Looks at the numbers of a table for signs that its author may have meant otherwise than they are read.
class NumberDoubts {
 public:
  /// A number as it stands: decimal points beside decimal commas in one table are doubtful.
  std::optional<NumberDoubt> look(std::string_view written, int line, std::size_t column);
  /// Words of one line: digits in groups of three behind a blank, beside other separators, are doubtful.
  static std::optional<NumberDoubt> look(const std::vector<TableWord>& words, const std::string& text, int line);
  /// At the end: decimal commas are doubtful where each could part thousands ("1,234").
  std::optional<NumberDoubt> left() const;

 private:
  std::optional<NumberDoubt> group_;  ///< the first number whose comma could part thousands
  bool point_ = false, comma_ = false, settled_ = false;
};

/// The column of the first words "1,234" of a line that commas part, which may be one number; 0 for none.
std::size_t grouped_by_comma(const std::vector<TableWord>& words, const std::string& text);

}  // namespace talus
