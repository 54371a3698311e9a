// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/table_lines.hpp"

namespace talus::solver {
namespace {

using Words = std::vector<TableWord>;

/// A table of numbers under the names of its columns, which its first line gives.
class TableReader : public TableLines {
 public:
  using TableLines::TableLines;

  /// Calls name_columns(words) for the first line that says something, and add_row() for each one after it.
  template <class NameColumns, class AddRow>
  void read(const NameColumns& name_columns, const AddRow& add_row) {
    std::size_t columns = 0;
    while (next()) {
      if (columns == 0) {
        name_columns(words());
        columns = words().size();
      } else if (words().size() != columns) {
        refuse(fmt::format("{} words", words().size()), fmt::format("the first line names {} columns", columns),
               "Mend the line");
      } else {
        add_row();
      }
    }
  }
};

constexpr std::size_t most_hydrograph_rows = 1'000'000;

/// A table with the columns time_s and discharge_m3_s.
class HydrographReader {
 public:
  HydrographReader(const std::filesystem::path& file, const std::string& place)
      : file_(file), table_(file, "Check file of " + place) {}

  Hydrograph read(double scale) {
    table_.read([this](const Words& words) { name_columns(words); }, [this] { add_row(); });
    if (times_.size() < 2)
      throw DataError({fmt::format("{}: it has {} rows of numbers", file_.string(), times_.size()),
                       "a hydrograph has two at least", "Give a constant discharge as two rows"});
    for (double& discharge : discharges_) discharge *= scale;
    return {std::move(times_), std::move(discharges_)};
  }

 private:
  void name_columns(const Words& words) {
    const auto place_of = [&](const char* name) {
      const auto at = std::ranges::find(words, name, &TableWord::text);
      if (at == words.end() || std::ranges::count(words, name, &TableWord::text) > 1)
        table_.refuse(fmt::format("no column, or more than one, is called {}", name),
                      "the first line names the columns", "Begin the file with the line time_s,discharge_m3_s");
      return static_cast<std::size_t>(std::distance(words.begin(), at));
    };
    time_at_ = place_of("time_s");
    discharge_at_ = place_of("discharge_m3_s");
  }

  void add_row() {
    const double time = table_.number(time_at_), discharge = table_.number(discharge_at_);
    if (!(time >= 0))
      table_.refuse(fmt::format("time_s = {:g}", time), "the run begins at 0", "Count time from the start of the run");
    if (!times_.empty() && !(time > times_.back()))
      table_.refuse(fmt::format("time_s = {:g} after {:g}", time, times_.back()), "times must grow from row to row",
                    "Sort the rows; a jump is two rows a moment apart");
    if (!(discharge >= 0))
      table_.refuse(fmt::format("discharge_m3_s = {:g}", discharge), "nothing is taken out through the line",
                    "Give 0 where nothing enters");
    if (times_.size() == most_hydrograph_rows)
      table_.refuse(fmt::format("more than {} rows", most_hydrograph_rows), "no hydrograph needs so many",
                    "Give every tenth row");
    times_.push_back(time);
    discharges_.push_back(discharge);
  }

  const std::filesystem::path& file_;
  TableReader table_;
  std::size_t time_at_ = 0, discharge_at_ = 0;
  std::vector<double> times_, discharges_;
};

/// An hour of samples every millisecond has no more.
constexpr std::size_t most_rows = 4'000'000;
constexpr std::uintmax_t most_bytes = 512u << 20;
constexpr double standard_gravity = 9.80665;  // [m/s2]

/// The columns that a file may have.
enum Name { time_s, east, north, up, along, across, names };
constexpr std::array<std::string_view, names> words{"time_s", "east", "north", "up", "along", "across"};

/// A table with the columns time_s and some of the components of an acceleration.
class AccelerogramReader {
 public:
  explicit AccelerogramReader(const ShakingOptions& options)
      : options_(options), table_(options.file, "Check [solve.shaking] file") {
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(options_.file, unknown);
    if (unknown) table_.refuse_unopened();
    if (bytes > most_bytes)
      throw DataError({fmt::format("{}: {} bytes", options_.file.string(), bytes),
                       fmt::format("an accelerogram of {} rows has no more than {}", most_rows, most_bytes),
                       "Give the strong part of the record, or every second row"});
  }

  Shaking read() {
    table_.read([this](const Words& found) { name_columns(found); }, [this] { add_row(); });
    if (times_.size() < 2)
      throw DataError({options_.file.string(), fmt::format("it has {} rows of numbers", times_.size()),
                       "An accelerogram has two at least"});
    Shaking shaking = make_shaking(times_, accelerations_);
    if (!std::isfinite(length(shaking.samples.back().velocity)))
      throw DataError(
          {options_.file.string(), "the velocity of the ground is beyond all numbers", "Check its unit and its scale"});
    return shaking;
  }

 private:
  /// The first line names the columns: time_s, and some of the components, of one of the two kinds.
  void name_columns(const Words& found) {
    constexpr const char* mend =
        "Name the columns in the first line: time_s and some of east, north, up; or time_s and some of along, across, "
        "up, with azimuth_deg in [solve.shaking]";
    bool has[names] = {};
    for (const auto& [word, written, column] : found) {
      const auto at = std::find(words.begin(), words.end(), word);
      if (at == words.end())
        table_.refuse(fmt::format("\"{:.60}\"", written), "it is no name of a column", mend, column);
      const auto name = static_cast<Name>(std::distance(words.begin(), at));
      if (has[name]) table_.refuse(fmt::format("two columns \"{}\"", word), "only one can act", mend);
      has[name] = true;
      columns_.push_back(name);
    }
    const bool mapped = has[east] || has[north], turned = has[along] || has[across];
    if (!has[time_s] || found.size() < 2) table_.refuse("no time_s with an acceleration", "both are needed", mend);
    if (mapped && turned) table_.refuse("columns along and across beside east and north", "they are the same", mend);
    if (turned && !options_.azimuth)
      table_.refuse("columns along or across", "it is not said where they point",
                    "Give [solve.shaking] azimuth_deg, the direction of along from north over east");
    if (!turned && options_.azimuth)
      table_.refuse("no column along or across", "azimuth_deg would have no effect",
                    "Leave [solve.shaking] azimuth_deg out, or name the columns by it");
  }

  void add_row() {
    double value[names] = {};
    for (std::size_t n = 0; n < columns_.size(); ++n) value[columns_[n]] = table_.number(n);
    const double time = value[time_s];
    if (times_.empty()) first_ = time;
    const double at = options_.start + (time - first_);
    if (!times_.empty() && !(at > times_.back()))
      table_.refuse(fmt::format("time_s = {:g}", time), "times must grow from row to row",
                    "Sort the rows, and leave out those of the same time");
    if (times_.size() == most_rows)
      table_.refuse(fmt::format("more than {} rows", most_rows), "no accelerogram has so many",
                    "Give every second row");
    times_.push_back(at);
    accelerations_.push_back(on_the_map(value));
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
  TableReader table_;
  std::vector<Name> columns_;
  double first_ = 0;  ///< time of the first row [s]
  std::vector<double> times_;
  std::vector<Vec3<double>> accelerations_;
};

}  // namespace

Hydrograph::Hydrograph(std::vector<double> times, std::vector<double> discharges)
    : times_(std::move(times)), discharges_(std::move(discharges)), volumes_{0} {
  for (std::size_t n = 1; n < times_.size(); ++n)
    volumes_.push_back(volumes_.back() + 0.5 * (discharges_[n - 1] + discharges_[n]) * (times_[n] - times_[n - 1]));
}

double Hydrograph::volume_until(double time) const {
  if (time <= times_.front()) return 0;
  if (time >= times_.back()) return volumes_.back();
  const auto next =
      static_cast<std::size_t>(std::distance(times_.begin(), std::upper_bound(times_.begin(), times_.end(), time)));
  const double since = time - times_[next - 1], share = since / (times_[next] - times_[next - 1]);
  return volumes_[next - 1] +
         since * (discharges_[next - 1] + 0.5 * share * (discharges_[next] - discharges_[next - 1]));
}

std::vector<std::pair<double, double>> Hydrograph::spells() const {
  std::vector<std::pair<double, double>> spells;
  for (std::size_t n = 1; n < times_.size(); ++n) {
    if (!(discharges_[n - 1] + discharges_[n] > 0)) continue;
    const bool goes_on = !spells.empty() && spells.back().second == times_[n - 1] && discharges_[n - 1] > 0;
    if (goes_on)
      spells.back().second = times_[n];
    else
      spells.emplace_back(times_[n - 1], times_[n]);
  }
  return spells;
}

double Hydrograph::peak() const { return *std::max_element(discharges_.begin(), discharges_.end()); }

Hydrograph read_hydrograph(const InflowOptions& options, const std::string& place) {
  if (!options.file.empty()) return HydrographReader(options.file, place).read(options.scale);
  std::vector<double> times, discharges;
  for (const auto& [time, discharge] : options.hydrograph) {
    times.push_back(time);
    discharges.push_back(discharge * options.scale);
  }
  return {std::move(times), std::move(discharges)};
}

Shaking read_shaking(const ShakingOptions& options) {
  if (options.record) return *options.record;
  return options.acts() ? AccelerogramReader(options).read() : Shaking{};
}

}  // namespace talus::solver
