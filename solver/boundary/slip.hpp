// What a basal law knows of the slip of the mass over its bed at one place.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// The slip of the mass over its bed at one place.
template <class Real>
struct Slip {
  Real speed;          ///< along the bed [m/s]
  Real normal_stress;  ///< with which the mass presses on it [Pa]; known where a law asks for it (Law::asks_pressure)
  Real duration;       ///< of the step [s]
};

/// The setting that the numbers of a basal law follow from, besides its options.
struct BedSetting {
  double borne;    ///< share of the normal stress that the grains bear, water the rest [-]
  double density;  ///< of the mass [kg/m3]
  double gravity;  ///< [m/s2]
};

}  // namespace talus
