// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/sum.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

std::string grouped(double value) { return grouped(fmt::format("{:.0f}", value), ","); }

std::string grouped(std::string number, const char* between) {
  const std::size_t start = number.starts_with('-') ? 1 : 0;
  for (std::size_t i = std::min(number.find('.'), number.size()); i > start + 3;) number.insert(i -= 3, between);
  return number;
}

}  // namespace talus
