// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/stage/input_file.hpp"

namespace talus::preprocess {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), lower(name)) != names.end();
}

/// "Depth (m)" is depth in m, "depth_us_ft" depth in us ft.
struct NameAndUnit {
  std::string name, unit;
};

NameAndUnit split(std::string_view text) {
  constexpr std::string_view parting = "_-([ ])";
  const std::size_t end = std::min(text.find_first_of(parting), text.size());
  NameAndUnit result{lower(text.substr(0, end)), ""};
  for (const char c : lower(text.substr(end))) {
    const bool parts = parting.find(c) != std::string_view::npos;
    if (!parts) result.unit += c;
    if (parts && !result.unit.empty() && result.unit.back() != ' ') result.unit += ' ';
  }
  while (result.unit.ends_with(' ')) result.unit.pop_back();
  return result;
}

/// The units that stand behind names; other words are part of the name ("depth of bedrock", "height above").
bool is_unit(std::string_view text) {
  return is_one_of(text, {"", "m", "metre", "metres", "meter", "meters", "ft", "foot", "feet", "us ft", "ft us",
                          "us survey foot", "us survey feet"});
}

bool is_place_name(std::string_view text, std::initializer_list<std::string_view> names) {
  const auto [name, unit] = split(text);
  return (unit.empty() || unit == "m") && is_one_of(name, names);
}

bool is_x_name(std::string_view text) { return is_place_name(text, {"x", "easting", "east", "longitude", "lon"}); }
bool is_y_name(std::string_view text) { return is_place_name(text, {"y", "northing", "north", "latitude", "lat"}); }

/// The line without its comment, cut at separators and stripped of quotes.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  for (char c : line.substr(0, line.find('#')) + ' ') {
    if (c == ',' || c == ';' || c == '\t' || c == ' ' || c == '\r') {
      if (!word.empty()) words.push_back(std::move(word));
      word.clear();
    } else if (c != '"') {
      word += c;
    }
  }
  return words;
}

std::optional<double> number_of(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Columns {
  std::array<std::size_t, 3> of{0, 1, 2};  // x, y, z
  HeightName z;
};

/// A unit in brackets belongs to the name before it.
std::vector<std::string> names_of_header(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words) {
    if (!names.empty() && (word.starts_with('(') || word.starts_with('['))) {
      names.back() += word;
    } else {
      names.push_back(word);
    }
  }
  return names;
}

/// A header is a first line that names all three columns. Where depths are read too, they go before elevations, which
/// beside them are the ground's.
std::optional<Columns> columns_of_header(const std::vector<std::string>& words, PointHeights heights) {
  const std::vector<std::string> names = names_of_header(words);
  std::array<std::optional<std::size_t>, 3> found;
  HeightName z;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_x_name(names[i])) found[0] = i;
    if (is_y_name(names[i])) found[1] = i;
    const auto height = height_name(names[i]);
    if (!height || (height->depth ? heights == PointHeights::elevations : z.depth)) continue;
    found[2] = i;
    z = *height;
  }
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  return Columns{{*found[0], *found[1], *found[2]}, z};
}

[[noreturn]] void refuse_line(const std::filesystem::path& file, int line_number, const std::string& line) {
  throw DataError(Fault{fmt::format("{}: line {}: \"{}\"", file.string(), line_number, line.substr(0, 60)),
                        "not three numbers x, y, z", "Mend the line, or name the columns x,y,z in a first line"});
}

}  // namespace

std::optional<HeightName> height_name(std::string_view text) {
  const auto [name, unit] = split(text);
  const bool depth = name == "depth";
  if (!is_unit(unit) || (!depth && !is_one_of(name, {"z", "elevation", "elev", "height", "altitude"})))
    return std::nullopt;
  return HeightName{depth, unit};
}

ScatteredPoints read_point_table(const std::filesystem::path& file, PointHeights heights) {
  require_plain(file);
  std::ifstream stream(file);
  if (!stream)
    throw DataError(Fault{file.string() + ": cannot be opened", "missing or not readable", "Check the path"});
  ScatteredPoints points;
  Columns columns;
  std::string line;
  bool first = true;
  for (int line_number = 1; std::getline(stream, line); ++line_number) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (std::exchange(first, false)) {
      if (const auto named = columns_of_header(words, heights)) {
        columns = *named;
        points.are_depths = named->z.depth;
        points.unit = named->z.unit;
        continue;
      }
    }
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = columns.of[i] < words.size() ? number_of(words[columns.of[i]]) : std::nullopt;
      if (!value) refuse_line(file, line_number, line);
      xyz[i] = *value;
    }
    points.x.push_back(xyz[0]);
    points.y.push_back(xyz[1]);
    points.z.push_back(xyz[2]);
  }
  require_read(stream, file);
  return points;
}

}  // namespace talus::preprocess
