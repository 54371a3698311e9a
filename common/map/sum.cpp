// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/sum.hpp"

#include <fmt/format.h>

namespace talus {

std::string grouped(double value) {
  std::string digits = fmt::format("{:.0f}", value);
  const std::size_t start = digits.front() == '-' ? 1 : 0;
  for (std::size_t i = digits.size(); i > start + 3;) digits.insert(i -= 3, ",");
  return digits;
}

}  // namespace talus
