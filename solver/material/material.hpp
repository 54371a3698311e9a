// Constitutive laws. What a point keeps in `elastic`:
//   linear-elastic  Cauchy stress [Pa], advanced by Hooke's law and the Jaumann rate (the paper's stress update)
//   hencky          elastic logarithmic strain; Kirchhoff stress is linear in it (Hencky 1928; de Souza Neto et al. 2008, ch. 13)
//   corotated       the same strain; the stress is linear in the stretch, P = R (2G (U - I) + lambda tr(U - I) I), so that a bar keeps
//                   force = E times engineering strain (Chao et al. 2010)
//   drucker-prager  its deviator; the pressure is a function of the total volume alone, so that a grain that has opened must
//                   close again before it carries load (cf. Tampubolon et al. 2017, volume correction)
#pragma once

#include "solver/material/hencky.hpp"

namespace talus {

enum class MaterialModel { linear_elastic, hencky, corotated, drucker_prager };

/// Pressure p = -trace(tau)/3 is positive in compression; sqrt(J2) is the shear measure of the cone.
template <class Real>
struct Material {
  MaterialModel model = MaterialModel::drucker_prager;
  Real density = 0;          // [kg/m3]
  Real shear_modulus = 0;    // G [Pa]
  Real bulk_modulus = 0;     // K [Pa]
  Real wave_speed = 0;       // sqrt((K + 4G/3) / density) [m/s]
  Real friction = 0;         // slope alpha of sqrt(J2) = alpha p + shear_cohesion [-]
  Real dilatancy = 0;        // slope beta of the plastic potential [-]
  Real shear_cohesion = 0;   // [Pa]
  Real tension = 0;          // largest -p carried [Pa]
};

template <class Real>
struct MaterialState {
  Sym3<Real> elastic;
  Real log_volume{};          // ln J
  Real plastic_log_volume{};  // part of it from dilatancy
};

/// What B-bar gives a point instead of its own volume change (mean_dilation.hpp).
template <class Real>
struct MeanVolume {
  bool on = false;
  Real increment{};  // of ln J over the step
  Real stress{};     // mean Kirchhoff stress of its element [Pa]
};

/// Pressure of a Drucker-Prager point, tension cut off.
template <class Real>
TALUS_HD Real granular_pressure(const Material<Real>& m, const MaterialState<Real>& s) {
  const Real p = -m.bulk_modulus * (s.log_volume - s.plastic_log_volume);
  return p > -m.tension ? p : -m.tension;
}

/// Kirchhoff stress tau = J sigma [Pa].
template <class Real>
TALUS_HD Sym3<Real> kirchhoff_stress(const Material<Real>& m, const MaterialState<Real>& s) {
  switch (m.model) {
    case MaterialModel::linear_elastic:
      return s.elastic * exp(s.log_volume);
    case MaterialModel::hencky: {
      const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
      return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(s.elastic));
    }
    case MaterialModel::corotated: {
      const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
      const Sym3<Real> d = stretch_deviation(s.elastic * Real(0.5));  // V - I
      const Sym3<Real> linear = (d * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(d));
      return linear + commuting_product(d, linear);
    }
    default:
      return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(-granular_pressure(m, s));
  }
}

/// Elastic energy per initial volume [J/m3].
template <class Real>
TALUS_HD Real elastic_energy(const Material<Real>& m, const MaterialState<Real>& s) {
  switch (m.model) {
    case MaterialModel::linear_elastic: {
      const Real mean = trace(s.elastic) / Real(3);
      return exp(s.log_volume) * (norm_squared(deviator(s.elastic)) / (Real(4) * m.shear_modulus) +
                                  mean * mean / (Real(2) * m.bulk_modulus));
    }
    case MaterialModel::hencky: {
      const Real volume = trace(s.elastic);
      return m.shear_modulus * norm_squared(deviator(s.elastic)) + Real(0.5) * m.bulk_modulus * volume * volume;
    }
    case MaterialModel::corotated: {
      const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
      const Sym3<Real> d = stretch_deviation(s.elastic * Real(0.5));
      const Real volume = trace(d);
      return m.shear_modulus * norm_squared(d) + Real(0.5) * lame * volume * volume;
    }
    default: {
      const Real p = granular_pressure(m, s);
      return m.shear_modulus * norm_squared(s.elastic) + Real(0.5) * p * p / m.bulk_modulus;
    }
  }
}

/// Hooke's law on the strain increment, stress turned with the spin (Jaumann rate).
template <class Real>
TALUS_HD void advance_linear(const Material<Real>& m, const Mat3<Real>& g, Sym3<Real>& stress) {
  const Sym3<Real> strain{g.a.x, g.b.y, g.c.z, Real(0.5) * (g.a.y + g.b.x), Real(0.5) * (g.b.z + g.c.y),
                          Real(0.5) * (g.a.z + g.c.x)};
  const Real wxy = Real(0.5) * (g.b.x - g.a.y), wyz = Real(0.5) * (g.c.y - g.b.z), wxz = Real(0.5) * (g.c.x - g.a.z);
  const Sym3<Real> s = stress;
  const Sym3<Real> turned{Real(2) * (wxy * s.xy + wxz * s.xz),
                          Real(2) * (-wxy * s.xy + wyz * s.yz),
                          Real(-2) * (wxz * s.xz + wyz * s.yz),
                          wxy * (s.yy - s.xx) + wxz * s.yz + wyz * s.xz,
                          wyz * (s.zz - s.yy) - wxy * s.xz - wxz * s.xy,
                          wxz * (s.zz - s.xx) + wxy * s.yz - wyz * s.xy};
  const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
  stress = s + turned + (strain * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(strain));
}

/// Return to the Drucker-Prager cone, smooth part or tension cut-off (de Souza Neto et al. 2008, box 8.8, non-associated).
template <class Real>
TALUS_HD void return_to_cone(const Material<Real>& m, MaterialState<Real>& s) {
  const Real shear = Real(2) * m.shear_modulus * sqrt(Real(0.5) * norm_squared(s.elastic));  // sqrt(J2) of the trial
  const Real pressure = granular_pressure(m, s);
  const Real excess = shear - m.friction * pressure - m.shear_cohesion;
  if (excess <= Real(0)) return;
  // Dilatancy raises the pressure as the point shears; an open point has none to raise.
  const bool closed = m.dilatancy > Real(0) && pressure > -m.tension;
  const Real beta = closed ? m.dilatancy : Real(0);
  const Real multiplier = excess / (m.shear_modulus + m.friction * m.bulk_modulus * beta);
  Real left = shear - m.shear_modulus * multiplier;
  if (left < Real(0)) left = Real(0);  // apex: no shear strength at this pressure
  s.elastic = s.elastic * (left / shear);
  s.plastic_log_volume += beta * multiplier;
}

/// Advance the state over a step with displacement gradient g = dt grad v, and the mean volume change where that is on.
template <class Real>
TALUS_HD void advance_material(const Material<Real>& m, const Mat3<Real>& g, MaterialState<Real>& s, const MeanVolume<Real>& mean = {}) {
  const Real own = log_volume_change(g), change = mean.on ? mean.increment : own;
  s.log_volume += change;
  switch (m.model) {
    case MaterialModel::linear_elastic:
      advance_linear(m, g, s.elastic);
      break;
    case MaterialModel::hencky:
    case MaterialModel::corotated:
      s.elastic = advance_strain(s.elastic, g);
      if (mean.on) s.elastic = s.elastic.plus_identity((change - own) / Real(3));
      break;
    default:
      s.elastic = deviator(advance_strain(s.elastic, g));
      return_to_cone(m, s);
  }
}

}  // namespace talus
