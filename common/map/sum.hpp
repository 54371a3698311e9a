// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums that keep their digits, and numbers as people write them.
#pragma once

#include <cmath>
#include <string>

namespace talus {

/// Neumaier's compensated sum (1974): the error does not grow with the count.
class Sum {
 public:
  /// Adds one value.
  void add(double value) {
    const double total = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - total) + value : (value - total) + sum_;
    sum_ = total;
  }
  /// The sum of all values added.
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0, rest_ = 0;
};

/// Rounded to a whole number, in groups of three: "36,003,420".
std::string grouped(double value);
/// A written number with `between` between its groups.
std::string grouped(std::string number, const char* between);

}  // namespace talus
