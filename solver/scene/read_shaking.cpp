// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/read_shaking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/input_file.hpp"
#include "solver/scene/table_words.hpp"

namespace talus::solver {
namespace {

/// An hour of samples every millisecond has no more.
constexpr std::size_t most_rows = 4'000'000;
constexpr std::uintmax_t most_bytes = 512u << 20;
constexpr double standard_gravity = 9.80665;  // [m/s2]

/// The columns that a file may have.
enum Name { time_s, east, north, up, along, across, names };
constexpr std::array<std::string_view, names> words{"time_s", "east", "north", "up", "along", "across"};

/// A table of numbers under the names of its columns, read line by line.
class AccelerogramReader {
 public:
  explicit AccelerogramReader(const ShakingOptions& options) : options_(options) {}

  Shaking read() {
    open();
    std::string line;
    while (std::getline(stream_, line)) {
      ++line_number_;
      const std::vector<std::string> found = words_of(line);
      if (found.empty()) continue;
      if (columns_.empty()) {
        name_columns(found);
      } else {
        add_row(found);
      }
    }
    require_read(stream_, options_.file);
    if (times_.size() < 2)
      refuse(options_.file.string(), fmt::format("it has {} rows of numbers", times_.size()),
             "An accelerogram has two at least");
    Shaking shaking = make_shaking(times_, accelerations_);
    if (!std::isfinite(length(shaking.samples.back().velocity)))
      refuse(options_.file.string(), "the velocity of the ground is beyond all numbers",
             "Check its unit and its scale");
    return shaking;
  }

 private:
  [[noreturn]] static void refuse(std::string what, std::string why, std::string mend) {
    throw DataError(Fault{std::move(what), std::move(why), std::move(mend)});
  }
  [[noreturn]] void refuse_line(const std::string& what, const std::string& why, const std::string& mend) const {
    refuse(fmt::format("{}: line {}: {}", options_.file.string(), line_number_, what), why, mend);
  }

  void open() {
    require_plain(options_.file);
    stream_.open(options_.file);
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(options_.file, unknown);
    if (!stream_ || unknown)
      refuse(options_.file.string() + ": cannot be opened", "missing or not readable", "Check [solve.shaking] file");
    if (bytes > most_bytes)
      refuse(fmt::format("{}: {} bytes", options_.file.string(), bytes),
             fmt::format("an accelerogram of {} rows has no more than {}", most_rows, most_bytes),
             "Give the strong part of the record, or every second row");
  }

  /// The first line names the columns: time_s, and some of the components, of one of the two kinds.
  void name_columns(const std::vector<std::string>& found) {
    constexpr const char* mend =
        "Name the columns in the first line: time_s and some of east, north, up; or time_s and some of along, across, "
        "up, with azimuth_deg in [solve.shaking]";
    bool has[names] = {};
    for (const std::string& word : found) {
      const auto at = std::find(words.begin(), words.end(), word);
      if (at == words.end()) refuse_line(fmt::format("\"{:.60}\"", word), "it is no name of a column", mend);
      const auto name = static_cast<Name>(std::distance(words.begin(), at));
      if (has[name]) refuse_line(fmt::format("two columns \"{}\"", word), "only one can act", mend);
      has[name] = true;
      columns_.push_back(name);
    }
    const bool mapped = has[east] || has[north], turned = has[along] || has[across];
    if (!has[time_s] || found.size() < 2) refuse_line("no time_s with an acceleration", "both are needed", mend);
    if (mapped && turned) refuse_line("columns along and across beside east and north", "they are the same", mend);
    if (turned && !options_.azimuth)
      refuse_line("columns along or across", "it is not said where they point",
                  "Give [solve.shaking] azimuth_deg, the direction of along from north over east");
    if (!turned && options_.azimuth)
      refuse_line("no column along or across", "azimuth_deg would have no effect",
                  "Leave [solve.shaking] azimuth_deg out, or name the columns by it");
  }

  void add_row(const std::vector<std::string>& found) {
    if (found.size() != columns_.size())
      refuse_line(fmt::format("{} words", found.size()),
                  fmt::format("the first line names {} columns", columns_.size()), "Mend the line");
    double value[names] = {};
    for (std::size_t n = 0; n < found.size(); ++n) value[columns_[n]] = number(found[n]);
    const double time = value[time_s];
    if (times_.empty()) first_ = time;
    const double at = options_.start + (time - first_);
    if (!times_.empty() && !(at > times_.back()))
      refuse_line(fmt::format("time_s = {:g}", time), "times must grow from row to row",
                  "Sort the rows, and leave out those of the same time");
    if (times_.size() == most_rows)
      refuse_line(fmt::format("more than {} rows", most_rows), "no accelerogram has so many", "Give every second row");
    times_.push_back(at);
    accelerations_.push_back(on_the_map(value));
  }

  double number(const std::string& word) const {
    const std::optional<double> value = number_in(word);
    if (!value) refuse_line(fmt::format("\"{:.60}\"", word), "it is no finite number", "Mend the line");
    return *value;
  }

  /// The components of a row along x, y and z [m/s2].
  Vec3<double> on_the_map(const double (&value)[names]) const {
    const double unit = options_.unit == ShakingUnit::g       ? standard_gravity
                        : options_.unit == ShakingUnit::cm_s2 ? 0.01
                                                              : 1.0,
                 turn = options_.azimuth.value_or(0) * (std::numbers::pi / 180), factor = unit * options_.scale;
    const Vec3<double> ahead{std::sin(turn), std::cos(turn), 0}, aside{std::cos(turn), -std::sin(turn), 0};
    return (Vec3<double>{value[east], value[north], value[up]} + ahead * value[along] + aside * value[across]) * factor;
  }

  const ShakingOptions& options_;
  std::ifstream stream_;
  int line_number_ = 0;
  std::vector<Name> columns_;
  double first_ = 0;  ///< time of the first row [s]
  std::vector<double> times_;
  std::vector<Vec3<double>> accelerations_;
};

}  // namespace

Shaking read_shaking(const ShakingOptions& options) {
  if (options.record) return *options.record;
  return options.acts() ? AccelerogramReader(options).read() : Shaking{};
}

}  // namespace talus::solver
