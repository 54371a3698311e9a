// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Medians and quantiles, sums that keep their digits, and numbers as people write them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// Neumaier's compensated sum (1974): the error does not grow with the count.
class Sum {
 public:
  void add(double value) {
    const double total = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - total) + value : (value - total) + sum_;
    sum_ = total;
  }
  double value() const { return sum_ + rest_; }  ///< the sum of all values added

 private:
  double sum_ = 0, rest_ = 0;
};

/// Rounded to a whole number, in groups of three: "36,003,420".
std::string grouped(double value);
/// A number with so many decimals, or with more where less than two digits would be left of it.
std::string fixed(double value, int decimals);
/// A written number with `between` between its groups.
std::string grouped(std::string number, const char* between);

/// The value below which a share `q` of the values lies, linear between them (Hyndman and Fan 1996, type 7); NaN: none.
double quantile(std::vector<double> values, double q);

/// The value below which a further draw lies with a probability `q`, of draws in growing order (type 6).
double quantile_of_draws(const std::vector<double>& sorted, double q);

/// The value below which 99 % of the values above 0 lie, as quantile() has it: what a map holds where there is
/// anything, without its few largest cells. NaN where there is none.
double p99_of_positive(const std::vector<double>& values);

/// The middle value: quantile() at 0.5. NaN where there is none.
double median(const std::vector<double>& values);

/// The median thickness by volume [m]: half the volume stands in columns that are thicker. 0 where there is none.
double median_thickness(const Raster& thickness);

/// 1.4826 median(|v - median(v)|): the standard deviation of a normal distribution, unmoved by outliers (Hoehle &
/// Hoehle 2009, Tab. 2). NaN where there is no value.
double nmad(const std::vector<double>& values);

/// Mean, standard deviation (over n - 1; 0 for a single value) and quantiles of what is not NaN.
struct Spread {
  double mean = 0, deviation = 0, low = 0, high = 0;  ///< low, high: 5 % and 95 % quantile
};
/// The spread of the values that are not NaN; all members are NaN where there is none.
Spread spread_of(std::vector<double> values);

}  // namespace talus
