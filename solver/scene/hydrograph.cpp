// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/hydrograph.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/input_file.hpp"
#include "solver/scene/table_words.hpp"

namespace talus::solver {
namespace {

constexpr std::size_t most_hydrograph_rows = 1'000'000;

/// A table with the columns time_s and discharge_m3_s, read line by line.
class HydrographReader {
 public:
  HydrographReader(const std::filesystem::path& file, std::string place) : file_(file), place_(std::move(place)) {}

  Hydrograph read(double scale) {
    require_plain(file_);
    std::ifstream stream(file_);
    if (!stream)
      throw DataError({file_.string() + ": cannot be opened", "missing or not readable", "Check file of " + place_});
    std::string line;
    while (std::getline(stream, line)) {
      ++line_number_;
      const std::vector<std::string> words = words_of(line);
      if (words.empty()) continue;
      if (named_) {
        add_row(words);
      } else {
        name_columns(words);
      }
    }
    require_read(stream, file_);
    if (times_.size() < 2)
      throw DataError({fmt::format("{}: it has {} rows of numbers", file_.string(), times_.size()),
                       "a hydrograph has two at least", "Give a constant discharge as two rows"});
    for (double& discharge : discharges_) discharge *= scale;
    return {std::move(times_), std::move(discharges_)};
  }

 private:
  [[noreturn]] void refuse_line(const std::string& what, const std::string& why, const std::string& mend) const {
    throw DataError({fmt::format("{}: line {}: {}", file_.string(), line_number_, what), why, mend});
  }

  void name_columns(const std::vector<std::string>& words) {
    const auto place_of = [&](const char* name) {
      const auto at = std::find(words.begin(), words.end(), name);
      if (at == words.end() || std::count(words.begin(), words.end(), name) > 1)
        refuse_line(fmt::format("no column, or more than one, is called {}", name), "the first line names the columns",
                    "Begin the file with the line time_s,discharge_m3_s");
      return static_cast<std::size_t>(std::distance(words.begin(), at));
    };
    time_at_ = place_of("time_s");
    discharge_at_ = place_of("discharge_m3_s");
    columns_ = words.size();
    named_ = true;
  }

  double number_of(const std::string& word) const {
    const std::optional<double> value = number_in(word);
    if (!value) refuse_line(fmt::format("\"{:.60}\"", word), "it is no finite number", "Mend the line");
    return *value;
  }

  void add_row(const std::vector<std::string>& words) {
    if (words.size() != columns_)
      refuse_line(fmt::format("{} words", words.size()), fmt::format("the first line names {} columns", columns_),
                  "Mend the line");
    const double time = number_of(words[time_at_]), discharge = number_of(words[discharge_at_]);
    if (!(time >= 0))
      refuse_line(fmt::format("time_s = {:g}", time), "the run begins at 0", "Count time from the start of the run");
    if (!times_.empty() && !(time > times_.back()))
      refuse_line(fmt::format("time_s = {:g} after {:g}", time, times_.back()), "times must grow from row to row",
                  "Sort the rows; a jump is two rows a moment apart");
    if (!(discharge >= 0))
      refuse_line(fmt::format("discharge_m3_s = {:g}", discharge), "nothing is taken out through the line",
                  "Give 0 where nothing enters");
    if (times_.size() == most_hydrograph_rows)
      refuse_line(fmt::format("more than {} rows", most_hydrograph_rows), "no hydrograph needs so many",
                  "Give every tenth row");
    times_.push_back(time);
    discharges_.push_back(discharge);
  }

  const std::filesystem::path& file_;
  std::string place_;
  int line_number_ = 0;
  bool named_ = false;
  std::size_t time_at_ = 0, discharge_at_ = 0, columns_ = 0;
  std::vector<double> times_, discharges_;
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
    if (goes_on) {
      spells.back().second = times_[n];
    } else {
      spells.emplace_back(times_[n - 1], times_[n]);
    }
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

}  // namespace talus::solver
