// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a constitutive law knows of a material point: its elasticity, its state and the deformation of a step.
#pragma once

#include <cmath>

#include "solver/material/strain.hpp"

namespace talus {

/// The isotropic elasticity and density, which every law has.
template <class Real>
struct Elasticity {
  Real density = 0;        ///< [kg/m3]
  Real shear_modulus = 0;  ///< G [Pa]
  Real bulk_modulus = 0;   ///< K [Pa]
  Real wave_speed = 0;     ///< sqrt((K + 4G/3) / density) [m/s]

  /// The first constant of Lame, K - 2G/3 [Pa].
  TALUS_HD Real lame() const { return bulk_modulus - Real(2.0 / 3) * shear_modulus; }
};

/// The largest ln J that a point keeps. What has opened twenty thousand times is alone: its gradient is that of its own
/// affine velocity, which nothing turns back, so that ln J would grow with time without end.
inline constexpr double widest_opening = 10;

/// The state of a material point. `elastic` is its elastic logarithmic strain, or its Cauchy stress where the law keeps
/// that instead (Law::keeps_strain).
template <class Real>
struct MaterialState {
  Sym3<Real> elastic;
  Real log_volume{};          ///< ln J
  Real plastic_log_volume{};  ///< part of it from dilatancy
  Real plastic_shear{};       ///< equivalent plastic shear strain of this step, sqrt(2/3) of the deviatoric one's size
};

/// The means that B-bar gives a point instead of its own volume change (T17b).
template <class Real>
struct MeanVolume {
  bool on = false;
  Real increment{};  ///< of ln J over the step
  Real stress{};     ///< mean Kirchhoff stress of its element [Pa]
};

/// The deformation of a point over a step; strain over `duration` is the rate.
template <class Real>
struct Increment {
  Mat3<Real> gradient;  ///< of the displacement, over the configuration at the start of the step [-]
  Real duration;        ///< [s]
  Real own;             ///< change of ln J that follows from the gradient
  Real volume;          ///< change of ln J that counts: `own`, or the mean of its element (B-bar)
  bool averaged;        ///< whether that is the mean of its element

  TALUS_HD Increment(const Mat3<Real>& g, Real seconds, const MeanVolume<Real>& mean)
      : gradient(g),
        duration(seconds),
        own(log_volume_change(g)),
        volume(mean.on ? mean.increment : own),
        averaged(mean.on) {}
  /// The strain of the trial with the volume change that counts.
  TALUS_HD Sym3<Real> average(const Sym3<Real>& strain) const {
    return averaged ? strain.plus_identity((volume - own) / Real(3)) : strain;
  }
};

/// The trial of a step in its principal axes: elastic as if nothing yielded.
template <class Real>
struct PrincipalTrial {
  Real strain[3];           ///< logarithmic [-]
  Real log_volume;          ///< at the end of the step
  Real plastic_log_volume;  ///< at its start
  Real duration;            ///< of the step [s]
  bool heads = false;       ///< whether `ahead` is known
  Real ahead[3]{};          ///< strain of the way that the point is about to go from here, in the same axes [-]
};

/// The displacement gradient of a point with the way that it is about to go from there: `ahead()` gives the gradient of
/// that way, of any size, and is asked only where `heads`.
template <class Real, class Ahead>
struct HeadedGradient : Mat3<Real> {
  bool heads;
  Ahead ahead;
};

/// The principal Kirchhoff stresses tau_a [Pa] and their derivatives D_ab by the trial strains, row-major, of (T17).
template <class Real>
struct PrincipalResponse {
  Real tau[3], d[9];

  /// The mean of the principal stresses [Pa].
  TALUS_HD Real mean_stress() const { return (tau[0] + tau[1] + tau[2]) / Real(3); }
  /// The derivative of the mean stress by the volume change [Pa]; the rest of D has rows that sum to zero.
  TALUS_HD Real bulk() const {
    Real sum = 0;
    for (const Real value : d) sum += value;
    return sum / Real(9);
  }
  /// The method makes all numbers NaN: for laws that have no principal response, and recipes that ask for none (B-bar
  /// refuses them).
  TALUS_HD void refuse() {
    for (Real& value : tau) value = Real(NAN);
    for (Real& value : d) value = Real(NAN);
  }
};

}  // namespace talus
