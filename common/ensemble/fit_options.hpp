// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [fit] table: which keys `talus fit` changes until a run agrees with the survey.
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

}  // namespace talus
