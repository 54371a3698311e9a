// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a basal law knows of the slip of the mass over its bed at one place.
#pragma once

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
  const Real* here;        ///< those of the place, which rasters can give
  const Real* everywhere;  ///< those of the scene
  /// Number n of the place.
  TALUS_HD Real operator[](int n) const { return here[n]; }
};

}  // namespace talus
