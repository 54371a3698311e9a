// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one reader of tables in text files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/table_words.hpp"

namespace talus {

/// The lines of a table in a text file that say something. Each method throws DataError with file, line and column.
class TableLines {
 public:
  /// Opens a file. `mend`: of a file that cannot be opened. Refused too: no plain file, UTF-16.
  TableLines(const std::filesystem::path& file, std::string mend);

  /// Goes to the next line with words; false at the end. Refused: numbers that can be read in two ways.
  bool next();
  const std::vector<TableWord>& words() const { return words_; }
  const std::string& text() const { return text_; }  ///< the line as it stands
  double number(std::size_t word) const;             ///< the number that a word of the line is

  /// Refuses the line, or a place in it.
  [[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& mend,
                           std::size_t column = 0) const;
  [[noreturn]] void refuse_unopened() const;

 private:
  void refuse(const NumberDoubt& doubt) const;

  std::filesystem::path file_;
  std::string mend_, text_;
  std::ifstream stream_;
  std::vector<TableWord> words_;
  NumberDoubts doubts_;
  int line_ = 0;
};

}  // namespace talus
