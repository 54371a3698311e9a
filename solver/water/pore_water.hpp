// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The water between the grains as kernels see it: stiffness and permeability of the grains' skeleton, its dilatancy,
// and the limits of the pressure (T50).
#pragma once

#include <cmath>

#include "solver/parallel/math.hpp"

namespace talus {

/// The effective stress of a point without water in its pores, and of one that has not met a step with water yet. Those
/// that have water have 0 or more.
inline constexpr int no_water = -1, water_to_come = -2;

/// The tangent of the angle of dilatancy, and its derivative by the effective stress, 0 or less [1/Pa].
template <class Real>
struct Dilatancy {
  Real tangent{}, slope{};
};

/// The water of a scene and the skeleton of its grains.
template <class Real>
struct PoreWater {
  Real fluid_density = 0;    ///< rho_f [kg/m3]
  Real viscosity = 0;        ///< mu_f [Pa s]
  Real solid_fraction = 0;   ///< m_0, at the start [-]
  Real critical = 0;         ///< m_crit, to which slow shear leads [-]; 0: shear does not change the volume
  Real permeability = 0;     ///< k at m_0 [m2]
  Real compressibility = 0;  ///< a of (T50b) [-]
  Real reference = 0;        ///< sigma_0 of (T50b) [Pa]
  Real grain_inertia = 0;    ///< density of the grains times their diameter squared [kg/m]
  Real suction = 0;          ///< largest, at which air comes in [Pa]
  Real meniscus = 0;         ///< depth of water that the surface lacks at that suction [m]
  Real friction = 0;         ///< tan of the friction angle inside, 0: none [-]
  bool drained_bed = false, sealed_surface = false;

  /// The same in another precision.
  template <class To>
  PoreWater<To> as() const {
    return {.fluid_density = static_cast<To>(fluid_density),
            .viscosity = static_cast<To>(viscosity),
            .solid_fraction = static_cast<To>(solid_fraction),
            .critical = static_cast<To>(critical),
            .permeability = static_cast<To>(permeability),
            .compressibility = static_cast<To>(compressibility),
            .reference = static_cast<To>(reference),
            .grain_inertia = static_cast<To>(grain_inertia),
            .suction = static_cast<To>(suction),
            .meniscus = static_cast<To>(meniscus),
            .friction = static_cast<To>(friction),
            .drained_bed = drained_bed,
            .sealed_surface = sealed_surface};
  }

  /// The solid fraction once the volume has changed by water that came in, as ln of the volume [-]; never all of it.
  TALUS_HD Real solid_at(Real log_volume) const {
    constexpr Real least = Real(0.01), most = Real(0.95);
    const Real solid = Real(solid_fraction * exp(-log_volume));
    return solid > least ? (solid < most ? solid : most) : least;
  }
  /// The stiffness of the skeleton against strain across the bed, (T50b) (Iverson & George 2014) [Pa].
  TALUS_HD Real stiffness(Real solid, Real effective) const {
    return solid * ((effective > Real(0) ? effective : Real(0)) + reference) / compressibility;
  }
  /// The compression of the skeleton by a change of the effective stress [Pa], (T50b) integrated [-].
  TALUS_HD Real strain(Real solid, Real before, Real after) const {
    const Real from = (before > Real(0) ? before : Real(0)) + reference,
               to = (after > Real(0) ? after : Real(0)) + reference;
    return Real(compressibility / solid * log(to / from));
  }
  /// The permeability over the viscosity, k by Kozeny and Carman (Carman 1937), (T50c) [m2/(Pa s)].
  TALUS_HD Real mobility(Real solid) const {
    const Real pores = (Real(1) - solid) / (Real(1) - solid_fraction), grains = solid_fraction / solid;
    return permeability / viscosity * pores * pores * pores * grains * grains;
  }
  /// The dilatancy tan(psi) = m - m_crit / (1 + sqrt N) at a rate of shear [1/s], (T50d) (Iverson & George 2014;
  /// Boyer, Guazzelli & Pouliquen 2011 without the grains' inertia).
  TALUS_HD Dilatancy<Real> dilatancy(Real solid, Real effective, Real rate) const {
    if (!(critical > Real(0)) || !(rate > Real(0))) return {};
    constexpr Real least = 1;  // [Pa]
    const Real load = grain_inertia * rate * rate + (effective > least ? effective : least);
    const Real root = Real(sqrt(viscosity * rate / load)), over = Real(1) / (Real(1) + root);
    return {solid - critical * over, Real(-0.5) * critical * root * over * over / load};
  }
  /// The effective stress after a shear of `shear` at a rate [1/s] that lets no water in or out, (T50e) [Pa]: stiffness
  /// grows with the stress, so that it goes exponentially. Implicit in the dilatancy. It grows by e at most: what lies
  /// thin shears without end, and its suction ends soon after.
  TALUS_HD Real sheared(Real solid, Real effective, Real shear, Real rate) const {
    const Dilatancy<Real> d = dilatancy(solid, effective, rate);
    const Real share = solid * shear / compressibility, from = effective + reference;
    const Real way = share * d.tangent / (Real(1) - share * from * d.slope);
    const Real to = from * Real(exp(way < Real(1) ? way : Real(1))) - reference;
    return to > Real(0) ? to : Real(0);
  }
  /// The pressure at the surface of a mass that has taken in a depth of water since the start [m]: there is no other
  /// water over it, and its grains draw in the surface (T50i) [Pa].
  TALUS_HD Real surface_pressure(Real taken) const {
    const Real share = taken / meniscus;
    return share > Real(0) ? -suction * (share < Real(1) ? share : Real(1)) : Real(0);
  }
  /// The strength by friction of grains under this load across the bed [Pa] that bear `effective`, as
  /// ParticleState::water_strength has it: the share that is left of it, or below 0 a suction beside it [Pa].
  TALUS_HD Real strength(Real load, Real effective) const {
    if (effective < load) return effective > Real(0) ? effective / load : Real(0);
    const Real sucked = effective - load < suction ? effective - load : suction;
    return sucked > Real(0) ? -sucked : Real(1);
  }
  /// The share of their friction on the bed that grains have under this load across it [Pa], of which they bear
  /// `effective` [-].
  TALUS_HD Real strength_share(Real load, Real effective) const {
    if (!(load > Real(0))) return Real(1);
    const Real share = effective / load, most = Real(1) + suction / load;
    return share < Real(0) ? Real(0) : share < most ? share : most;
  }
};

}  // namespace talus
