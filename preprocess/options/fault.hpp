// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How messages call the recipe's table of this stage.
#pragma once

#include <string>
#include <utility>

#include "common/error.hpp"

namespace talus::preprocess {

/// This function makes a fault of [preprocess]; `what` begins with the key, "grid.spacing_m = -10".
inline Fault fault(std::string what, std::string why, std::string mend) {
  return {"[preprocess]: " + std::move(what), std::move(why), std::move(mend)};
}

}  // namespace talus::preprocess
