// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What laws without plastic flow have in common: no options or numbers of their own, and a trial that is the end.
#pragma once

#include "solver/material/law_list.hpp"
#include "solver/material/state.hpp"

namespace talus {

/// The base of an elastic law; `Law` is the law itself, so that each has its own types.
template <class Law>
struct ElasticLaw {
  static constexpr bool stiffness_is_free = false, steps_implicitly = true;
  using LoadedAs = Law;

  /// The law has no keys of its own.
  struct Options {
    /// There are no keys.
    void describe(recipe::Visitor&, const LawTable&) {}
    /// Whether strength falls as the material shears.
    bool softens() const { return false; }
    /// Whether shear changes the volume of the material.
    bool dilates() const { return false; }
  };

  /// The law has no numbers of its own.
  template <class Real>
  struct Numbers {
    /// Plastic shear strain changes nothing.
    TALUS_HD void soften(Real) {}
    /// There is no tip to round.
    void round_tip(Real) {}
    /// There is no friction that pressure could change.
  };
  /// The numbers of the law, of which there are none.
  template <class Real>
  static Numbers<Real> numbers(const Options&, double) {
    return {};
  }

  /// This function makes the state at the end of a step whose trial strain is in `s`.
  template <class Real>
  TALUS_HD static void settle(const Elasticity<Real>&, const Numbers<Real>&, const Increment<Real>& step,
                              MaterialState<Real>& s) {
    s.elastic = step.average(s.elastic);
  }

  /// The part of the elastic state that gravity loading gave it with which a point goes on: all of it.
  template <class Real>
  static Sym3<Real> after_loading(const Sym3<Real>& loaded) {
    return loaded;
  }
};

}  // namespace talus
