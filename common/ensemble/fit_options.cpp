// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/fit_options.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/ensemble/counts.hpp"

namespace talus {
namespace {

constexpr int fewest_runs = 5, most_runs = 100;
constexpr std::size_t most_keys = 2;

}  // namespace

void FitOptions::describe(recipe::Visitor& v) {
  v.names(
      "keys", keys, {},
      "one or two keys that are changed, with their tables (\"solve.base.friction_angle_deg\"); empty: the friction "
      "of the bed's law");
  v.numbers("low", low, recipe::any, "smallest value of each; empty: a quarter of the recipe's");
  v.numbers("high", high, recipe::any, "largest value of each; empty: four times the recipe's, of angles 60 at most");
  v.integer("runs", runs, {fewest_runs, most_runs}, "number of runs at most");
  v.needs(keys.size() <= most_keys && (keys.size() < most_keys || keys.front() != keys.back()),
          {"[fit] keys names a key twice or more than two", "a deposit tells no more than two apart",
           "Name one or two, and give the others their values"});
  for (const auto& [name, bounds] : {std::pair{"low", &low}, {"high", &high}})
    v.needs(bounds->empty() || bounds->size() == keys.size(),
            {std::string("[fit] ") + name + " and keys differ in length", "each key has a bound of its own",
             "Give one for each of the keys, in their order"});
  for (std::size_t n = 0; n < low.size() && n < high.size(); ++n)
    v.needs(low[n] < high[n], {"[fit] low is not below high", "no value lies between them", "Mend one of them"});
}

void CalibrateNumber::describe(recipe::Visitor& v) {
  std::vector<std::string_view> known;
  for (const ResultNumber& number : result_numbers) known.emplace_back(number.name);
  v.text("result", result, "a result of members.csv that was measured, with its unit: \"largest_speed_m_s\"");
  v.needs(std::ranges::find(known, result) != known.end() || result.starts_with("gauge_"),
          {fmt::format("[[calibrate.number]] result = \"{}\"", result), "members have no result of this name",
           fmt::format("Give one of {}, or at a gauge as \"gauge_NAME_arrival_s\"", fmt::join(known, ", "))});
  v.number("value", value, recipe::any, "what was measured");
  v.number("deviation", deviation, recipe::not_negative, "its standard error");
  v.needs(value != 0, {"[[calibrate.number]] value is 0",
                       "the size of the model's discrepancy is sought relative to it", "Give a number that is not 0"});
}

void CalibrateOptions::describe(recipe::Visitor& v) {
  v.number("cell_factor", cell_factor, {1, 8},
           "calibrate first with cells so many times as large, then correct; 1: not");
  recipe::list(v, "number", numbers, "a measured number that is compared besides the survey's map");
}

}  // namespace talus
