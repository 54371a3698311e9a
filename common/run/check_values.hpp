// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Are the numbers of a file possible? What is read is looked at before it is used.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"

namespace talus::h5 {

/// The numbers that may stand in a dataset.
struct Allowed {
  double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
  bool none = false;  ///< NaN says that there is no value
  const char* why = "numbers must be finite";
};

/// Any finite number.
inline constexpr Allowed finite{};
/// Any finite number, or none.
inline constexpr Allowed finite_or_none{.none = true, .why = "numbers must be finite, or NaN where there is none"};
/// 0 or more.
inline constexpr Allowed not_negative{.low = 0, .why = "it cannot be negative, nor NaN, nor without end"};
/// 0 or more, or none.
inline constexpr Allowed not_negative_or_none{
    .low = 0, .none = true, .why = "it cannot be negative, nor without end; NaN stands for none"};

/// Refuses the file where a value of dataset `path` is not allowed.
template <class T>
void check_values(const File& file, const std::string& path, std::span<const T> values, const Allowed& allowed) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto value = static_cast<double>(values[n]);
    if ((value >= allowed.low && value <= allowed.high) || (allowed.none && std::isnan(value))) continue;
    file.refuse(fmt::format("dataset {} holds {:g} at place {}", path, value, n), allowed.why);
  }
}

/// Refuses the file where an attribute is not allowed.
inline double checked_number(const File& file, const std::string& object, const std::string& name,
                             const Allowed& allowed) {
  const double value = file.number(object, name);
  if (!((value >= allowed.low && value <= allowed.high) || (allowed.none && std::isnan(value))))
    file.refuse(fmt::format("attribute {} {} is {:g}", object, name, value), allowed.why);
  return value;
}

/// Refuses the file where a list does not grow from value to value, or holds a number that is not finite.
inline void check_growing(const File& file, const std::string& path, std::span<const double> values, bool strictly) {
  check_values(file, path, values, finite);
  for (std::size_t n = 1; n < values.size(); ++n) {
    if (strictly ? values[n] > values[n - 1] : values[n] >= values[n - 1]) continue;
    file.refuse(fmt::format("dataset {} holds {:g} behind {:g}", path, values[n], values[n - 1]), "times must grow");
  }
}

}  // namespace talus::h5
