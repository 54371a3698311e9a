// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction by a table: coefficients at given slip speeds, linear between them and constant beyond them (T13).
#pragma once

#include <algorithm>
#include <string>

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// The law of friction that a table of slip speeds gives.
struct FrictionTable : BasalLaw {
  static constexpr std::string_view name = "table";
  static constexpr int most_rows = 24;  ///< they go to kernels by value

  /// The keys of the law: the rows of the table.
  struct Options {
    recipe::Pairs table{{0, 0.6}, {10, 0.25}};  ///< slip speeds [m/s] and coefficients [-]

    void describe(recipe::Visitor& v, const LawTable& law) {
      v.pairs("table", table, recipe::not_negative,
              "table: [[slip speed in m/s, friction coefficient], ...], at most 24 rows, each faster than the one "
              "before; linear between them, the first and the last hold beyond them");
      v.needs(!table.empty() && table.size() <= most_rows,
              {law.name + " table has " + std::to_string(table.size()) + " rows", "it has 1 to 24",
               "Leave out rows that lie on a line between their neighbours"});
      const auto slower = [](const auto& a, const auto& b) { return a[0] >= b[0]; };
      v.needs(std::adjacent_find(table.begin(), table.end(), slower) == table.end(),
              {law.name + " table: speeds do not increase", "a speed has one coefficient",
               "Sort the rows by speed, and leave out repeated speeds"});
    }
  };
  static bool uses(std::string_view key) { return key == "table"; }
  template <class All>
  static std::string words(const All& o) {
    return "table of " + std::to_string(o.table.size()) + " speeds, " + ends(o);
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "friction by a table of " + std::to_string(o.table.size()) + " slip speeds, " + ends(o);
  }

  enum Number { count };  ///< no numbers of a place
  template <class All>
  static void numbers(const All&, const BedSetting&, double*) {}
  /// The speeds [m/s], then the coefficients [-]; the last row fills what is left.
  enum Constant { speed, mu = most_rows, constant_count = 2 * most_rows };
  template <class All>
  static void constants(const All& o, const BedSetting& setting, double* c) {
    for (std::size_t row = 0; row < most_rows; ++row) {
      const auto& [v, coefficient] = o.table[std::min(row, o.table.size() - 1)];
      c[speed + row] = v;
      c[mu + row] = setting.borne * coefficient;
    }
  }

  /// The ratio of friction to normal stress, mu(v) [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    const Real *v = n.everywhere + speed, *c = n.everywhere + mu;
    int row = 0;  // the first that is faster
    while (row < most_rows && !(slip.speed < v[row])) ++row;
    if (row == 0 || row == most_rows) return c[row == 0 ? 0 : most_rows - 1];
    return c[row - 1] + (c[row] - c[row - 1]) * ((slip.speed - v[row - 1]) / (v[row] - v[row - 1]));
  }

 private:
  template <class All>
  static std::string ends(const All& o) {
    const auto row = [](const auto& r) { return six_digits(r[1]) + " at " + six_digits(r[0]) + " m/s"; };
    return row(o.table.front()) + " to " + row(o.table.back());
  }
};

}  // namespace talus
