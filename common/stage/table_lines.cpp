// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/table_lines.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/files.hpp"
#include "common/text_encoding.hpp"

namespace talus {

TableLines::TableLines(const std::filesystem::path& file, std::string mend) : file_(file), mend_(std::move(mend)) {
  require_plain(file_);
  stream_.open(file_);
  if (!stream_) refuse_unopened();
  const std::string start = start_of(file_, 16);
  if (const std::string_view encoding = wide_encoding(start); !encoding.empty())
    throw DataError({fmt::format("{}: its text is {}", file_.string(), encoding), "a table is wanted as UTF-8",
                     mend_of_encoding(encoding, file_.string())});
}

bool TableLines::next() {
  while (std::getline(stream_, text_)) {
    if (++line_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
    words_ = placed_words(text_);
    if (words_.empty()) continue;
    if (const auto doubt = NumberDoubts::look(words_, text_, line_)) refuse(*doubt);
    for (const TableWord& word : words_)
      if (signed_number(word.text))
        if (const auto doubt = doubts_.look(word.written, line_, word.column)) refuse(*doubt);
    return true;
  }
  require_read(stream_, file_);
  if (const auto doubt = doubts_.left()) refuse(*doubt);
  return false;
}

double TableLines::number(std::size_t word) const {
  const TableWord& at = words_.at(word);
  if (const std::optional<double> value = signed_number(at.text)) return *value;
  const bool grouped = is_grouped(at.written);
  refuse(
      fmt::format("\"{:.60}\"", at.written),
      grouped ? "it is no number: a sign parts its thousands, or it has two decimal signs" : "it is no finite number",
      grouped ? "Write thousands without a sign" : "Mend the line", at.column);
}

void TableLines::refuse(const std::string& what, const std::string& why, const std::string& mend,
                        std::size_t column) const {
  const std::string at = column == 0 ? "" : fmt::format(", column {}", column);
  throw DataError({fmt::format("{}: line {}{}: {}", file_.string(), line_, at, what), why, mend});
}

void TableLines::refuse(const NumberDoubt& doubt) const {
  throw DataError(
      {fmt::format("{}: line {}, column {}: \"{:.60}\"", file_.string(), doubt.line, doubt.column, doubt.written),
       doubt.why, doubt.mend});
}

void TableLines::refuse_unopened() const {
  throw DataError({file_.string() + ": cannot be opened", "missing or not readable", mend_});
}

}  // namespace talus
