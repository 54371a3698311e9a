// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The laws without a friction coefficient: no options, no numbers, no force that follows from slip.
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
    void describe(recipe::Visitor&, const LawTable&) {}
  };
  static bool uses(std::string_view) { return false; }
  template <class All>
  static std::string words(const All&) {
    return Law::in_words;
  }
  template <class All>
  static std::string sentence(const All&) {
    return Law::in_a_sentence;
  }
  template <class All>
  static void numbers(const All&, const BedSetting&, double*) {}

  /// The ratio of friction to normal stress [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>&, const Slip<Real>&) {
    return Real(0);
  }
};

/// The law of a bed without friction.
struct NoFriction : FrictionlessLaw<NoFriction> {
  static constexpr std::string_view name = "none";
  static constexpr const char *in_words = "no friction", *in_a_sentence = "no friction";
};

/// The law of a bed that holds what presses on it.
struct Stick : FrictionlessLaw<Stick> {
  static constexpr std::string_view name = "stick";
  static constexpr bool holds = true;
  static constexpr const char *in_words = "held", *in_a_sentence = "no slip";
};

}  // namespace talus
