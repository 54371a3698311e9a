// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What most basal laws have in common: no numbers of the scene, no traction besides friction.
#pragma once

#include "solver/boundary/slip.hpp"
#include "solver/material/law_list.hpp"

namespace talus {

/// The base of the basal laws, with what a law that says nothing else does; see solver/boundary/law.hpp.
struct BasalLaw {
  static constexpr bool rubs = true, holds = false, asks_pressure = false, asks_column = false;
  static constexpr bool acts_at_rest = false;  ///< whether a search for the factor of safety takes the law
  static constexpr std::string_view friction_key = {};
  static constexpr int constant_count = 0;

  /// There is nothing that the keys of several laws need of one another.
  template <class All>
  static void check(recipe::Visitor&, const All&, const LawTable&) {}
  /// There are no numbers of the scene.
  template <class All>
  static void constants(const All&, const BedSetting&, double*) {}
  /// The traction that grows with speed [Pa].
  template <class Real>
  TALUS_HD static Real drag(const LawNumbers<Real>&, const Slip<Real>&) {
    return Real(0);
  }
  /// Whether there is such a traction.
  template <class Real>
  TALUS_HD static bool drags(const LawNumbers<Real>&) {
    return false;
  }
  /// The traction besides friction that acts at any speed, and at rest [Pa].
  template <class Real>
  TALUS_HD static Real yield(const LawNumbers<Real>&, const Slip<Real>&) {
    return Real(0);
  }
  /// Whether there is such a traction.
  template <class Real>
  TALUS_HD static bool yields(const LawNumbers<Real>&) {
    return false;
  }
};

}  // namespace talus
