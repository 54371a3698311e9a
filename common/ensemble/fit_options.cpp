// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/fit_options.hpp"

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

}  // namespace talus
