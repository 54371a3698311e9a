// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a basal law knows of the slip of the mass over its bed at one place, and what most of them have in common: no
// numbers of the scene, no traction besides friction.
#pragma once

#include "solver/material/law_list.hpp"
#include "solver/parallel/math.hpp"

namespace talus {

/// The slip of the mass over its bed at one place: of a base node, or of a column where the law acts on columns (drag,
/// yield, and the coefficient of a law that asks for the column).
template <class Real>
struct Slip {
  Real speed;          ///< along the bed [m/s]; of a column: the mean over it
  Real normal_stress;  ///< with which the mass presses on it [Pa]; known where a law asks for it (Law::asks_pressure).
                       ///< Of a column: its weight
  Real duration;       ///< of the step [s]
  Real load = 0;       ///< of a column: mass over the area of its bed [kg/m2]
};

/// The setting that the numbers of a basal law follow from, besides its options.
struct BedSetting {
  double borne;    ///< share of the normal stress that the grains bear, water the rest [-]
  double density;  ///< of the mass [kg/m3]
  double gravity;  ///< [m/s2]
};

/// The numbers of a basal law as kernels see them.
template <class Real>
struct LawNumbers {
  const Real* here;                                          ///< those of the place, which rasters can give
  const Real* everywhere;                                    ///< those of the scene
  TALUS_HD Real operator[](int n) const { return here[n]; }  ///< number n of the place
};

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
  template <class Real>
  TALUS_HD static bool drags(const LawNumbers<Real>&) {
    return false;
  }
  /// The traction besides friction that acts at any speed, and at rest [Pa].
  template <class Real>
  TALUS_HD static Real yield(const LawNumbers<Real>&, const Slip<Real>&) {
    return Real(0);
  }
  template <class Real>
  TALUS_HD static bool yields(const LawNumbers<Real>&) {
    return false;
  }
};

}  // namespace talus
