// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/sealed_file.hpp"

#include <limits>

#include <fmt/format.h>

#include "common/stage/checksum.hpp"
#include "common/stage/files.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus::h5 {

void write_grid(File& file, const std::string& group, const MapGrid& grid) {
  file.set_integer(group, "columns", grid.columns);
  file.set_integer(group, "rows", grid.rows);
  file.set_number(group, "west_m", grid.west);
  file.set_number(group, "south_m", grid.south);
  file.set_number(group, "cell_m", grid.cell);
  file.set_text(group, "crs_wkt", grid.crs_wkt);
  file.set_text(group, "row_order", "row 0 is the southernmost");
}

MapGrid read_grid(const File& file, const std::string& group) {
  const auto columns = file.integer(group, "columns"), rows = file.integer(group, "rows");
  constexpr auto limit = std::numeric_limits<int>::max();
  if (columns < 1 || rows < 1 || columns > limit || rows > limit)
    file.refuse("holds an impossible map grid", fmt::format("of {} columns and {} rows", columns, rows));
  const MapGrid grid{.columns = static_cast<int>(columns),
                     .rows = static_cast<int>(rows),
                     .west = file.number(group, "west_m"),
                     .south = file.number(group, "south_m"),
                     .cell = file.number(group, "cell_m"),
                     .crs_wkt = file.text(group, "crs_wkt")};
  if (!limits::hold(grid))
    file.refuse(fmt::format("attributes {} cell_m, west_m and south_m are {:g}, {:g} and {:g}", group, grid.cell,
                            grid.west, grid.south),
                "no map has such cells there");
  return grid;
}

void write_facts(File& file, const std::string& group, const std::vector<std::pair<std::string, std::string>>& facts) {
  file.make_group(group);
  for (std::size_t i = 0; i < facts.size(); ++i) {
    const auto one = fmt::format("{}/{:03}", group, i);
    file.make_group(one);
    file.set_text(one, "key", facts[i].first);
    file.set_text(one, "value", facts[i].second);
  }
}

std::vector<std::pair<std::string, std::string>> read_facts(const File& file, const std::string& group) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const auto& name : file.children(group)) {
    const auto one = fmt::format("{}/{}", group, name);
    facts.emplace_back(file.text(one, "key"), file.text(one, "value"));
  }
  return facts;
}

void write_text(File& file, const std::string& path, const std::string& text) {
  file.write_list<std::uint8_t>(path, std::vector<std::uint8_t>(text.begin(), text.end()));
}

std::string read_text(const File& file, const std::string& path) {
  const auto bytes = file.read_list<std::uint8_t>(path);
  return {bytes.begin(), bytes.end()};
}

void write_windows(File& file, const std::string& path, const std::vector<CellWindow>& windows) {
  std::vector<std::int32_t> numbers;
  for (const CellWindow& w : windows) numbers.insert(numbers.end(), {w.column, w.row, w.columns, w.rows});
  file.write<std::int32_t>(path, {windows.size(), 4}, numbers);
}

std::vector<CellWindow> read_windows(const File& file, const std::string& path, std::size_t count) {
  const auto numbers = file.read<std::int32_t>(path, {count, 4});
  std::vector<CellWindow> windows;
  for (std::size_t at = 0; at < numbers.size(); at += 4)
    windows.push_back({numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]});
  return windows;
}

void write_findings(File& file, const std::vector<Finding>& findings) {
  write_text(file, "/findings", to_json(findings));
}

std::vector<Finding> read_findings(const File& file) {
  auto findings = findings_in(read_text(file, "/findings"));
  if (!findings) file.refuse("dataset /findings is no list of findings", "it was edited or written by another program");
  return std::move(*findings);
}

void write_sealed(const std::filesystem::path& path, const std::function<void(File&)>& write, const std::string& mend) {
  PendingFile pending(path);
  File file = File::create(pending.path(), {path, mend});
  write(file);
  file.close();
  seal_file(pending.path(), path);
  pending.commit();
}

void set_format(File& file, const Format& format) {
  file.set_text("/", "format", format.mark);
  file.set_integer("/", "format_version", format.version);
}

File open_sealed(const std::filesystem::path& path, const Naming& naming) {
  require_seal(path, naming.mend);
  const WhileReading reading(path, naming.mend);
  return File::open(path, naming);
}

File open_sealed(const std::filesystem::path& path, const Naming& naming, const Format& format) {
  File file = open_sealed(path, naming);
  if (!file.has_attribute("/", "format") || file.text("/", "format") != format.mark)
    file.refuse(fmt::format("is not {}", format.words), "its mark is missing");
  const auto found = file.integer("/", "format_version");
  if (found != format.version) refuse_format(naming.shown, found, format.version, naming.mend);
  return file;
}

}  // namespace talus::h5
