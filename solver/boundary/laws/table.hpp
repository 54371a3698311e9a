// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction by a table: coefficients at given slip speeds, linear between them and constant beyond them (T13).
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// The law of friction that a table of slip speeds gives.
struct FrictionTable : BasalLaw {
  static constexpr std::string_view name = "table";
  static constexpr int most_rows = 24;  ///< they go to kernels by value

  /// The keys of the law: the rows of the table.
  struct Options {
    std::vector<double> table_speed{0, 10};            ///< [m/s]
    std::vector<double> table_coefficient{0.6, 0.25};  ///< [-]

    /// The method declares the keys with defaults, help and what they need of one another.
    void describe(recipe::Visitor& v, const LawTable& table) {
      v.numbers("table_speed_m_s", table_speed, recipe::not_negative,
                "table: slip speeds, each larger than the one before, at most 24; friction is linear between them");
      v.numbers("table_coefficient", table_coefficient, recipe::not_negative,
                "table: friction coefficient at each of these speeds; the first and the last hold beyond them");
      const std::size_t rows = table_speed.size();
      v.needs(rows == table_coefficient.size(),
              {table.name + " table_speed_m_s has " + std::to_string(rows) + " values, table_coefficient " +
                   std::to_string(table_coefficient.size()),
               "each speed has one coefficient", "Give both lists with equal lengths"});
      v.needs(rows >= 1 && rows <= most_rows,
              {table.name + " table_speed_m_s has " + std::to_string(rows) + " values", "a table has 1 to 24 rows",
               "Leave out rows that lie on a line between their neighbours"});
      v.needs(std::adjacent_find(table_speed.begin(), table_speed.end(), std::greater_equal<>()) == table_speed.end(),
              {table.name + " table_speed_m_s is not increasing", "a speed has one coefficient",
               "Sort the rows by speed, and leave out repeated speeds"});
    }
  };
  /// Whether the law looks at a key.
  static bool uses(std::string_view key) { return key == "table_speed_m_s" || key == "table_coefficient"; }
  /// The law in a line, for plan and log.
  template <class All>
  static std::string words(const All& o) {
    return "table of " + std::to_string(o.table_speed.size()) + " speeds, " + ends(o);
  }
  /// The law in a sentence of the report, "at its bed acts ...".
  template <class All>
  static std::string sentence(const All& o) {
    return "friction by a table of " + std::to_string(o.table_speed.size()) + " slip speeds, " + ends(o);
  }

  enum Number { count };  ///< no numbers of a place
  template <class All>
  static void numbers(const All&, const BedSetting&, double*) {}
  /// The speeds [m/s], then the coefficients [-]; the last row fills what is left.
  enum Constant { speed, mu = most_rows, constant_count = 2 * most_rows };
  /// This function makes the numbers of the scene from the options of all laws.
  template <class All>
  static void constants(const All& o, const BedSetting& setting, double* c) {
    for (std::size_t row = 0; row < most_rows; ++row) {
      const std::size_t given = std::min(row, o.table_speed.size() - 1);
      c[speed + row] = o.table_speed[given];
      c[mu + row] = setting.borne * o.table_coefficient[given];
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
    return six_digits(o.table_coefficient.front()) + " at " + six_digits(o.table_speed.front()) + " m/s to " +
           six_digits(o.table_coefficient.back()) + " at " + six_digits(o.table_speed.back()) + " m/s";
  }
};

}  // namespace talus
