// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the laws without a friction coefficient have in common: no options, no numbers, no force that follows from slip.
#pragma once

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// The base of a law without friction; `Law` is the law itself, so that each has its own types.
template <class Law>
struct FrictionlessLaw : BasalLaw {
  static constexpr bool rubs = false, acts_at_rest = true;
  static constexpr int count = 0;

  /// The law has no keys.
  struct Options {
    /// There are no keys.
    void describe(recipe::Visitor&, const LawTable&) {}
  };
  /// Whether the law looks at a key: at none.
  static bool uses(std::string_view) { return false; }
  /// There are no numbers.
  template <class All>
  static void numbers(const All&, const BedSetting&, double*) {}

  /// The ratio of friction to normal stress [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>&, const Slip<Real>&) {
    return Real(0);
  }
};

}  // namespace talus
