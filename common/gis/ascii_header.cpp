// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/ascii_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

namespace talus {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// One name for each thing that a header says, by all the names it goes by.
std::string_view meaning_of(const std::string& key) {
  static constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"columns", " ncols nbcols ncolumns "},
      {"rows", " nrows nbrows nlines "},
      {"west", " xllcorner xulcorner "},
      {"south", " yllcorner "},
      {"north", " yulcorner "},
      {"first x", " xllcenter xllcentre xulcenter xulcentre "},
      {"lowest y", " yllcenter yllcentre "},
      {"highest y", " yulcenter yulcentre "},
      {"cell", " cellsize "},
      {"dx", " dx xdim "},
      {"dy", " dy ydim "},
      {"nodata", " nodata_value nodata no_data_value no_data nodatavalue missing_value missing "}};
  for (const auto& [meaning, keys] : names)
    if (keys.find(" " + key + " ") != std::string_view::npos) return meaning;
  return {};
}

/// The keys that GDAL's driver itself knows.
bool gdal_knows(const std::string& key) {
  constexpr std::string_view keys = " ncols nrows xllcorner yllcorner xllcenter yllcenter dx dy cellsize nodata_value ";
  return keys.find(" " + key + " ") != std::string_view::npos;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words(1);
  for (const char c : line) {
    const bool parts = std::isspace(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '=';
    if (!parts) words.back() += c;
    if (parts && !words.back().empty()) words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool begins_a_key(const std::string& word) {
  return std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !is_word_for_nodata(word) &&
         !lower(word).starts_with("nan") && !lower(word).starts_with("inf");
}

/// Lines of the header, gathered by meaning.
struct Gathered {
  AsciiHeader header;
  std::map<std::string_view, std::string> values;
  bool first = true;

  void take(std::string_view line) {
    const std::vector<std::string> words = words_of(line);
    const std::string key = lower(words.front());
    const std::string_view meaning = meaning_of(key);
    // GDAL looks for a known key at the very start, and wants blanks between key and value.
    header.usual = header.usual && gdal_knows(key) && line.find_first_of(":=") == std::string_view::npos &&
                   std::isalpha(static_cast<unsigned char>(line.front())) != 0 && !(first && meaning == "nodata");
    first = false;
    if (meaning.empty() || words.size() < 2) return;
    header.usual = header.usual && lower(words[1]).find('d') == std::string::npos;
    values[meaning] = words[1];
    if (meaning == "cell" && words.size() > 2 && ascii_number(words[2])) {
      values["dx"] = words[1];
      values["dy"] = words[2];
    }
  }

  std::optional<double> number(std::string_view meaning) const {
    const auto found = values.find(meaning);
    return found == values.end() ? std::nullopt : ascii_number(found->second);
  }
};

std::optional<double> west_of(const Gathered& g, double dx) {
  if (const auto west = g.number("west")) return west;
  const auto x = g.number("first x");
  return x ? std::optional(*x - 0.5 * dx) : std::nullopt;
}

std::optional<double> south_of(const Gathered& g, double dy, double rows) {
  if (const auto south = g.number("south")) return south;
  if (const auto y = g.number("lowest y")) return *y - 0.5 * dy;
  if (const auto north = g.number("north")) return *north - rows * dy;
  const auto y = g.number("highest y");
  return y ? std::optional(*y + 0.5 * dy - rows * dy) : std::nullopt;
}

std::optional<AsciiHeader> written(Gathered&& g) {
  const auto columns = g.number("columns"), rows = g.number("rows");
  const auto cell = g.number("cell");
  const auto dx = g.number("dx") ? g.number("dx") : cell, dy = g.number("dy") ? g.number("dy") : cell;
  if (!columns || !rows || !dx || !dy) return std::nullopt;
  const auto west = west_of(g, *dx), south = south_of(g, *dy, *rows);
  if (!west || !south) return std::nullopt;
  const bool one_kind = g.values.contains("west") == g.values.contains("south");
  AsciiHeader header = std::move(g.header);
  header.usual = header.usual && one_kind;
  header.text =
      fmt::format("ncols {:.0f}\nnrows {:.0f}\nxllcorner {:.17g}\nyllcorner {:.17g}\n", *columns, *rows, *west, *south);
  header.text +=
      *dx == *dy ? fmt::format("cellsize {:.17g}\n", *dx) : fmt::format("dx {:.17g}\ndy {:.17g}\n", *dx, *dy);
  if (const auto nodata = g.values.find("nodata"); nodata != g.values.end()) {
    const auto value = ascii_number(nodata->second);
    header.nodata = value ? fmt::format("{:.17g}", *value) : "nan";
    header.text += "NODATA_value " + header.nodata + "\n";
  }
  return header;
}

}  // namespace

std::optional<double> ascii_number(std::string_view word) {
  std::string plain(word);
  for (char& c : plain) {
    if (c == ',') c = '.';
    if (c == 'd' || c == 'D') c = 'e';
  }
  const char* begin = plain.data() + (plain.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(begin, plain.data() + plain.size(), value);
  if (error == std::errc() && end == plain.data() + plain.size()) return value;
  return word.find("#IND") != word.npos || word.find("#QNAN") != word.npos ? std::optional(std::nan("")) : std::nullopt;
}

bool is_word_for_nodata(std::string_view word) {
  const std::string text = lower(word);
  return text == "*" || text == "-" || text == "--" || text == "na" || text == "n/a" || text == "null" ||
         text == "none" || text == "nodata" || text == "void";
}

std::optional<AsciiHeader> ascii_header(std::string_view start) {
  Gathered gathered;
  std::size_t at = 0;
  if (start.starts_with("\xEF\xBB\xBF")) at = 3, gathered.header.usual = false;
  while (at < start.size()) {
    const std::size_t end = std::min(start.find_first_of("\r\n", at), start.size());
    const std::string_view line = start.substr(at, end - at);
    const std::vector<std::string> words = words_of(line);
    const bool comment =
        !words.empty() && (words[0].starts_with('#') || words[0].starts_with("//") || words[0].starts_with(';'));
    if (comment || (words.empty() && gathered.first)) gathered.header.usual = false;
    if (!words.empty() && !comment) {
      // "NODATA -9999" is a key though a cell may say NODATA too.
      const bool key = begins_a_key(words[0]) || (words.size() == 2 && !meaning_of(lower(words[0])).empty());
      if (!key) break;
      gathered.take(line);
    }
    at = end + 1;
  }
  gathered.header.body_at = std::min(at, start.size());
  return written(std::move(gathered));
}

}  // namespace talus
