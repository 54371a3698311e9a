// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The friction between the mass and its bed.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"
#include "solver/boundary/base_friction.hpp"

namespace talus::solver {

struct SolveOptions;

/// A form, and what the recipe gives in it.
struct GivenForm {
  BedForm form;
  std::optional<double>* given;
};

/// The keys of [solve.base]: those of the laws (solver/boundary/laws), each law's declared in its header, and those
/// that act with every law that rubs.
struct BaseOptions : OptionsOfLaws<FrictionLaws> {
  FrictionLaw law = FrictionLaw::coulomb;
  double cohesion = 0;             ///< [Pa]
  double pore_pressure_ratio = 0;  ///< water's part of the normal stress [-]

  std::vector<std::string> given_as = {};  ///< the forms (BedForm) by whose keys the recipe gave numbers, as settled
  std::string given_twice = {};            ///< a form beside its number; empty: none is

  /// The forms in which the recipe may give numbers, with those that it gives and that are not settled.
  std::array<GivenForm, bed_forms.size()> forms();
  /// The number that the recipe calls by this name, null where it has none.
  double* named(std::string_view key);
  /// Whether the chosen law takes a number of the bed, as it is or by what its form gives.
  bool takes(std::string_view key) const;
  /// Makes numbers of the forms that the recipe gives. `gravity` [m/s2].
  void settle(double gravity);
  /// A number of the bed in the form in which the recipe gave it: its key and value.
  std::pair<std::string_view, double> as_given(std::string_view key, double value, double gravity) const;
  bool uses(std::string_view key) const;  ///< whether the chosen law uses a key
  std::vector<std::string> idle() const;  ///< the keys of numbers that are given for another law than the chosen one
  bool asks_column() const;               ///< whether the law's coefficient follows from weight and speed of a column
  std::string law_name() const;
  /// The key that alone decides the friction of the chosen law; empty where several do.
  std::string friction_key() const;
  /// The bed in a line, for plan and log.
  std::string words() const;
  /// The law in a sentence of the report, "at its bed acts ...".
  std::string sentence() const;

  /// Declares the keys of [solve.base] with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// The number that a form gives: the arctangent of mu [deg], to rounding; xi = g / k [m/s2].
double number_of(const BedForm& form, double value, double gravity);
/// The form of a number.
double form_of(const BedForm& form, double number, double gravity);

/// The law of the bed with the same numbers everywhere, in SI units.
template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options);

}  // namespace talus::solver
