// Constitutive laws. What a point keeps in `elastic`:
//   linear-elastic  Cauchy stress [Pa], advanced by Hooke's law and the Jaumann rate (the paper's stress update)
//   hencky          elastic logarithmic strain; Kirchhoff stress is linear in it (Hencky 1928; de Souza Neto et al.
//   2008, ch. 13) corotated       the same strain; the stress is linear in the stretch, P = R (2G (U - I) + lambda tr(U
//   - I) I), so that a bar keeps
//                   force = E times engineering strain (Chao et al. 2010)
//   drucker-prager  its deviator; the pressure is a function of the total volume alone, so that a grain that has opened
//   must
//                   close again before it carries load (cf. Tampubolon et al. 2017, volume correction)
#pragma once

#include "solver/material/hencky.hpp"

namespace talus {

enum class MaterialModel { linear_elastic, hencky, corotated, drucker_prager };

/// Pressure p = -trace(tau)/3 is positive in compression; sqrt(J2) is the shear measure of the cone.
template <class Real>
struct Material {
  MaterialModel model = MaterialModel::drucker_prager;
  Real density = 0;                                   // [kg/m3]
  Real shear_modulus = 0;                             // G [Pa]
  Real bulk_modulus = 0;                              // K [Pa]
  Real wave_speed = 0;                                // sqrt((K + 4G/3) / density) [m/s]
  Real friction = 0;                                  // slope alpha of sqrt(J2) = alpha p + shear_cohesion [-]
  Real dilatancy = 0;                                 // slope beta of the plastic potential [-]
  Real shear_cohesion = 0;                            // [Pa]
  Real tension = 0;                                   // largest -p carried [Pa]
  Real residual_friction = 0, residual_cohesion = 0;  // slope and shear cohesion once softened
  Real softening = 0;          // share of the way there per plastic shear strain; 0: does not soften [-]
  Real apex = 0;               // pressure over which the tip of the cone is rounded [Pa]
  bool exact_tangent = false;  // with what the volume change does to a yielding point's friction: not symmetric
};

template <class Real>
struct MaterialState {
  Sym3<Real> elastic;
  Real log_volume{};          // ln J
  Real plastic_log_volume{};  // part of it from dilatancy
  Real plastic_shear{};       // equivalent plastic shear strain of this step, sqrt(2/3) of the deviatoric one's size
};

inline constexpr int most_materials = 8;

/// A material that has yielded by this plastic shear strain: friction and cohesion on the way to what is left of them.
template <class Real>
TALUS_HD Material<Real> softened(Material<Real> m, Real plastic_shear) {
  const Real way = plastic_shear * m.softening, left = way < Real(1) ? Real(1) - way : Real(0);
  const Real cohesion = m.residual_cohesion + left * (m.shear_cohesion - m.residual_cohesion);
  m.friction = m.residual_friction + left * (m.friction - m.residual_friction);
  if (m.shear_cohesion > Real(0)) m.tension *= cohesion / m.shear_cohesion;
  m.shear_cohesion = cohesion;
  if (m.dilatancy > m.friction) m.dilatancy = m.friction;
  return m;
}

/// The materials of a scene. A scene of one that does not soften has no arrays on its points, and they all take the
/// first.
template <class Real>
struct Materials {
  Material<Real> list[most_materials];

  /// `which` and `plastic_shear` are the points' arrays; null where the scene needs none.
  TALUS_HD Material<Real> of(const int* which, const Real* plastic_shear, int p) const {
    const Material<Real>& m = which ? list[which[p]] : list[0];
    return plastic_shear ? softened(m, plastic_shear[p]) : m;
  }
  TALUS_HD Real density(const int* which, int p) const { return which ? list[which[p]].density : list[0].density; }
};

/// What B-bar gives a point instead of its own volume change (mean_dilation.hpp).
template <class Real>
struct MeanVolume {
  bool on = false;
  Real increment{};  // of ln J over the step
  Real stress{};     // mean Kirchhoff stress of its element [Pa]
};

/// Pressure that a Drucker-Prager point would have without cut-off, over the cut-off.
template <class Real>
TALUS_HD Real free_pressure(const Material<Real>& m, Real log_volume, Real plastic_log_volume) {
  return m.tension - m.bulk_modulus * (log_volume - plastic_log_volume);
}

/// The cut-off: what is left of a free pressure, max(y, 0), rounded over `apex` to (y + sqrt(y^2 + apex^2)) / 2, and
/// its derivative.
template <class Real>
struct CutPressure {
  Real value, slope;
  TALUS_HD CutPressure(const Material<Real>& m, Real y) {
    if (m.apex > Real(0)) {
      const Real root = sqrt(y * y + m.apex * m.apex);
      // The difference of two large numbers where the point has opened far.
      value = y > Real(0) ? Real(0.5) * (y + root) : Real(0.5) * m.apex * m.apex / (root - y);
      slope = value / root;
    } else {
      value = y > Real(0) ? y : Real(0);
      slope = y > Real(0) ? Real(1) : Real(0);
    }
  }
};

/// Pressure of a Drucker-Prager point, tension cut off.
template <class Real>
TALUS_HD Real granular_pressure(const Material<Real>& m, const MaterialState<Real>& s) {
  return CutPressure<Real>(m, free_pressure(m, s.log_volume, s.plastic_log_volume)).value - m.tension;
}

/// Kirchhoff stress tau = J sigma [Pa].
template <class Real>
TALUS_HD Sym3<Real> kirchhoff_stress(const Material<Real>& m, const MaterialState<Real>& s) {
  switch (m.model) {
    case MaterialModel::linear_elastic: return s.elastic * exp(s.log_volume);
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
    default: return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(-granular_pressure(m, s));
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
  const Sym3<Real> strain{
      g.a.x, g.b.y, g.c.z, Real(0.5) * (g.a.y + g.b.x), Real(0.5) * (g.b.z + g.c.y), Real(0.5) * (g.a.z + g.c.x)};
  const Real wxy = Real(0.5) * (g.b.x - g.a.y), wyz = Real(0.5) * (g.c.y - g.b.z), wxz = Real(0.5) * (g.c.x - g.a.z);
  const Sym3<Real> s = stress;
  const Sym3<Real> turned{Real(2) * (wxy * s.xy + wxz * s.xz),           Real(2) * (-wxy * s.xy + wyz * s.yz),
                          Real(-2) * (wxz * s.xz + wyz * s.yz),          wxy * (s.yy - s.xx) + wxz * s.yz + wyz * s.xz,
                          wyz * (s.zz - s.yy) - wxy * s.xz - wxz * s.xy, wxz * (s.zz - s.xx) + wxy * s.yz - wyz * s.xy};
  const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
  stress = s + turned + (strain * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(strain));
}

/// Where a trial of the Drucker-Prager cone ends (de Souza Neto et al. 2008, box 8.8, non-associated): shear - G g =
/// alpha p(g) + k with dilatancy raising the pressure by K beta g. The pressure is convex in g, so Newton's steps come
/// from one side.
template <class Real>
struct ConeReturn {
  Real left;                         // sqrt(J2) [Pa]
  Real dilation = 0;                 // plastic volume change
  Real pressure, give;               // pressure [Pa] and the slope of its cut-off there
  bool yields = false, tip = false;  // has yielded; no shear strength is left

  TALUS_HD ConeReturn(const Material<Real>& m, Real shear, Real y) : left(shear) {
    CutPressure<Real> cut(m, y);
    pressure = cut.value - m.tension;
    give = cut.slope;
    Real excess = shear - m.friction * pressure - m.shear_cohesion;
    if (excess <= Real(0)) return;
    yields = true;
    // An open point has no pressure to raise.
    const Real raise = give > Real(0) ? m.bulk_modulus * m.dilatancy : Real(0);
    Real multiplier = excess / (m.shear_modulus + m.friction * raise * give);
    const int corrections = raise > Real(0) && m.apex > Real(0) ? 4 : raise > Real(0) ? 1 : 0;
    for (int n = 0; n < corrections; ++n) {
      const CutPressure<Real> now(m, y + raise * multiplier);
      pressure = now.value - m.tension;
      give = now.slope;
      excess = shear - m.shear_modulus * multiplier - m.friction * pressure - m.shear_cohesion;
      multiplier += excess / (m.shear_modulus + m.friction * raise * give);
    }
    left = shear - m.shear_modulus * multiplier;
    dilation = raise > Real(0) ? m.dilatancy * multiplier : Real(0);
    if (left < Real(0)) {
      left = Real(0);
      tip = true;
    }
  }
};

/// Return of a point to the cone.
template <class Real>
TALUS_HD void return_to_cone(const Material<Real>& m, MaterialState<Real>& s) {
  const Real shear = Real(2) * m.shear_modulus * sqrt(Real(0.5) * norm_squared(s.elastic));  // sqrt(J2) of the trial
  const ConeReturn<Real> end(m, shear, free_pressure(m, s.log_volume, s.plastic_log_volume));
  if (!end.yields) return;
  const Real kept = end.left / shear;
  s.plastic_shear = sqrt(Real(2.0 / 3) * norm_squared(s.elastic)) * (Real(1) - kept);
  s.elastic = s.elastic * kept;
  s.plastic_log_volume += end.dilation;
}

/// Advance the state over a step with displacement gradient g = dt grad v, and the mean volume change where that is on.
template <class Real>
TALUS_HD void advance_material(const Material<Real>& m, const Mat3<Real>& g, MaterialState<Real>& s,
                               const MeanVolume<Real>& mean = {}) {
  const Real own = log_volume_change(g), change = mean.on ? mean.increment : own;
  s.log_volume += change;
  if (m.model == MaterialModel::linear_elastic) return advance_linear(m, g, s.elastic);
  s.elastic = advance_strain(s.elastic, g);
  if (m.model == MaterialModel::drucker_prager) {
    s.elastic = deviator(s.elastic);
    return_to_cone(m, s);
  } else if (mean.on) {
    s.elastic = s.elastic.plus_identity((change - own) / Real(3));
  }
}

}  // namespace talus
