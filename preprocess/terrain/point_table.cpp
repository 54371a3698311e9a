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

bool is_x_name(std::string_view name) { return is_one_of(name, {"x", "x_m", "easting", "east", "longitude", "lon"}); }
bool is_y_name(std::string_view name) { return is_one_of(name, {"y", "y_m", "northing", "north", "latitude", "lat"}); }

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

using Columns = std::array<std::size_t, 3>;  // of x, y, z

/// A header is a first line that names all three columns.
std::optional<Columns> columns_of_header(const std::vector<std::string>& words) {
  std::array<std::optional<std::size_t>, 3> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (is_x_name(words[i])) found[0] = i;
    if (is_y_name(words[i])) found[1] = i;
    if (is_z_name(words[i])) found[2] = i;
  }
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  return Columns{*found[0], *found[1], *found[2]};
}

[[noreturn]] void refuse_line(const std::filesystem::path& file, int line_number, const std::string& line) {
  throw DataError(Fault{fmt::format("{}: line {}: \"{}\"", file.string(), line_number, line.substr(0, 60)),
                        "not three numbers x, y, z", "Mend the line, or name the columns x,y,z in a first line"});
}

}  // namespace

bool is_z_name(std::string_view name) {
  return is_one_of(name, {"z", "z_m", "elevation", "elev", "height", "altitude"});
}

ScatteredPoints read_point_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream)
    throw DataError(Fault{file.string() + ": cannot be opened", "missing or not readable", "Check the path"});
  ScatteredPoints points;
  Columns columns{0, 1, 2};
  std::string line;
  bool first = true;
  for (int line_number = 1; std::getline(stream, line); ++line_number) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (std::exchange(first, false)) {
      if (const auto named = columns_of_header(words)) {
        columns = *named;
        continue;
      }
    }
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = columns[i] < words.size() ? number_of(words[columns[i]]) : std::nullopt;
      if (!value) refuse_line(file, line_number, line);
      xyz[i] = *value;
    }
    points.x.push_back(xyz[0]);
    points.y.push_back(xyz[1]);
    points.z.push_back(xyz[2]);
  }
  return points;
}

}  // namespace talus::preprocess
