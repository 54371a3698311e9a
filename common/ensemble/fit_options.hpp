// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [fit] and [calibrate] tables: which keys `talus fit` changes until a run agrees with the
// survey, and what `talus calibrate` compares besides the survey's map.
#pragma once

#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus {

/// The keys of [fit].
struct FitOptions {
  std::vector<std::string> keys;  ///< one or two; empty: the friction of the bed
  std::vector<double> low, high;  ///< bounds of each key; empty: a quarter and four times the recipe's value
  int runs = 16;                  ///< at most
  void describe(recipe::Visitor& v);
};

/// A measured number that members are compared with.
struct CalibrateNumber {
  std::string result;  ///< a number of members.csv: "largest_speed_m_s"
  double value = 0;
  double deviation = 0;  ///< standard error
  void describe(recipe::Visitor& v);
};

/// The keys of [calibrate].
struct CalibrateOptions {
  double cell_factor = 1;                ///< sides of the cells of a first, cheaper calibration; 1: there is none
  std::vector<CalibrateNumber> numbers;  ///< [[calibrate.number]]
  void describe(recipe::Visitor& v);
};

}  // namespace talus
