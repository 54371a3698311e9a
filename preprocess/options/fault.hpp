// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How messages call the recipe's table of this stage.
#pragma once

#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// Makes a fault of [preprocess]; `what` begins with the key, "grid.spacing_m = -10".
inline Fault fault(std::string what, std::string why, std::string mend) {
  return {"[preprocess]: " + std::move(what), std::move(why), std::move(mend)};
}

/// Declares what keys need of one another: the fault where it is not `met`.
inline void need(recipe::Visitor& v, bool met, std::string what, std::string why, std::string mend) {
  v.needs(met, fault(std::move(what), std::move(why), std::move(mend)));
}

}  // namespace talus::preprocess
