// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The elastic laws: Hencky's, corotated, neo-Hookean and small-strain elasticity. They have no options or numbers of
// their own, and their trial is the end.
#pragma once

#include "solver/material/law_list.hpp"
#include "solver/material/point_tangent.hpp"
#include "solver/material/state.hpp"

namespace talus {

/// The base of an elastic law; `Law` is the law itself, so that each has its own types.
template <class Law>
struct ElasticLaw {
  static constexpr bool stiffness_is_free = false, steps_implicitly = true;
  using LoadedAs = Law;

  /// The law has no keys of its own.
  struct Options {
    void describe(recipe::Visitor&, const LawTable&) {}
    bool softens() const { return false; }
    bool dilates() const { return false; }
  };

  /// The law has no numbers of its own.
  template <class Real>
  struct Numbers {
    TALUS_HD void soften(Real) {}  ///< plastic shear strain changes nothing
    void round_tip(Real) {}        ///< there is no tip to round
  };
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

/// The law of Hencky elasticity (Hencky 1928).
struct Hencky : ElasticLaw<Hencky> {
  static constexpr std::string_view name = "hencky";
  static constexpr bool keeps_strain = true, pressure_follows_volume = true;
  /// In uniaxial tension the nominal stress E ln(stretch) / stretch falls beyond a stretch of e: what is beyond tears.
  static constexpr double largest_strain = 1;

  static std::string words(const Options&, const std::string& elasticity) { return "elastic (hencky), " + elasticity; }
  static std::string sentence(const Options&) { return "an elastic material, linear in the logarithmic strain"; }

  /// The Kirchhoff stress tau = 2 G dev(epsilon) + K tr(epsilon) I (T14) [Pa].
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real lame = m.lame();
    return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(s.elastic));
  }

  /// The elastic energy G |dev(epsilon)|^2 + K tr(epsilon)^2 / 2 per initial volume [J/m3].
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real volume = trace(s.elastic);
    return m.shear_modulus * norm_squared(deviator(s.elastic)) + Real(0.5) * m.bulk_modulus * volume * volume;
  }

  /// The principal stresses of a trial, and D_ab = lambda + 2 G delta_ab of (T17).
  template <class Real>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers<Real>&, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out) {
    const Real* e = trial.strain;
    const Real twice = Real(2) * m.shear_modulus, lame = m.lame();
    const Real volume = e[0] + e[1] + e[2];
    for (int a = 0; a < 3; ++a) {
      out.tau[a] = twice * e[a] + lame * volume;
      for (int b = 0; b < 3; ++b) out.d[3 * a + b] = lame + (a == b ? twice : Real(0));
    }
  }
};

/// The law of corotated elasticity (Chao et al. 2010).
struct Corotated : ElasticLaw<Corotated> {
  static constexpr std::string_view name = "corotated";
  static constexpr bool keeps_strain = true, pressure_follows_volume = false;

  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (corotated), " + elasticity;
  }
  static std::string sentence(const Options&) { return "an elastic material, linear in the stretch"; }

  /// The Kirchhoff stress tau = V (2G (V - I) + lambda tr(V - I) I), V the left stretch [Pa].
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real lame = m.lame();
    const Sym3<Real> d = stretch_deviation(s.elastic * Real(0.5));  // V - I
    const Sym3<Real> linear = (d * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(d));
    return linear + commuting_product(d, linear);
  }

  /// The elastic energy G |V - I|^2 + lambda tr(V - I)^2 / 2 per initial volume [J/m3].
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real lame = m.lame();
    const Sym3<Real> d = stretch_deviation(s.elastic * Real(0.5));
    const Real volume = trace(d);
    return m.shear_modulus * norm_squared(d) + Real(0.5) * lame * volume * volume;
  }

  /// The principal stresses tau_a = s_a (2 G (s_a - 1) + lambda sum (s - 1)) of the stretches s, and D_ab of (T17).
  template <class Real>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers<Real>&, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out) {
    const Real* e = trial.strain;
    const Real twice = Real(2) * m.shear_modulus, lame = m.lame();
    Real stretch[3], excess[3], volume = 0;
    for (int a = 0; a < 3; ++a) {
      excess[a] = Real(expm1(e[a]));
      stretch[a] = Real(1) + excess[a];
      volume += excess[a];
    }
    for (int a = 0; a < 3; ++a) {
      out.tau[a] = stretch[a] * (twice * excess[a] + lame * volume);
      for (int b = 0; b < 3; ++b) {
        const Real own = a == b ? out.tau[a] + twice * stretch[a] * stretch[a] : Real(0);
        out.d[3 * a + b] = stretch[a] * stretch[b] * lame + own;
      }
    }
  }
};

/// The law of compressible neo-Hookean elasticity (Simo & Pister 1984).
struct NeoHookean : ElasticLaw<NeoHookean> {
  static constexpr std::string_view name = "neo-hookean";
  static constexpr bool keeps_strain = true, pressure_follows_volume = false;

  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (neo-hookean), " + elasticity;
  }
  static std::string sentence(const Options&) { return "a neo-Hookean elastic material"; }

  /// The Kirchhoff stress tau = G (b - I) + lambda ln J I, b = exp(2 epsilon) (T14a) [Pa].
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    return (stretch_deviation(s.elastic) * m.shear_modulus).plus_identity(m.lame() * trace(s.elastic));
  }

  /// The elastic energy G (tr(b) - 3) / 2 - G ln J + lambda (ln J)^2 / 2 per initial volume [J/m3]; rounding is that of
  /// G times the strain.
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real volume = trace(s.elastic);
    return m.shear_modulus * (Real(0.5) * trace(stretch_deviation(s.elastic)) - volume) +
           Real(0.5) * m.lame() * volume * volume;
  }

  /// A bound of the modulus of waves along the longest stretch l, G (l^2 + 1) + lambda (1 - ln J), over that of the
  /// material at rest; l^2 - 1 is no more than the size of b - I.
  template <class Real>
  TALUS_HD static Real stiffening(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real lame = m.lame(), rest = Real(2) * m.shear_modulus + lame;
    const Real more =
        Real(m.shear_modulus * sqrt(norm_squared(stretch_deviation(s.elastic))) - lame * trace(s.elastic));
    return Real(Real(1) + fmax(more, Real(0)) / rest);
  }

  /// The principal stresses of a trial, and D_ab = lambda + 2 G exp(2 epsilon_a) delta_ab of (T17).
  template <class Real>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers<Real>&, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out) {
    const Real* e = trial.strain;
    const Real lame = m.lame(), volume = e[0] + e[1] + e[2];
    for (int a = 0; a < 3; ++a) {
      const Real square = Real(expm1(Real(2) * e[a]));  // of the stretch, less one
      out.tau[a] = m.shear_modulus * square + lame * volume;
      for (int b = 0; b < 3; ++b)
        out.d[3 * a + b] = lame + (a == b ? Real(2) * m.shear_modulus * (Real(1) + square) : Real(0));
    }
  }
};

/// The law of small-strain elasticity, as in the reference paper.
struct LinearElastic : ElasticLaw<LinearElastic> {
  static constexpr std::string_view name = "linear-elastic";
  static constexpr bool keeps_strain = false, pressure_follows_volume = false;

  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (small strain), " + elasticity;
  }
  static std::string sentence(const Options&) { return "an elastic material of small strain"; }

  /// The Kirchhoff stress: J times the Cauchy stress [Pa].
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>&, const Numbers<Real>&, const MaterialState<Real>& s) {
    return s.elastic * Real(exp(s.log_volume));
  }

  /// The elastic energy J (|dev(sigma)|^2 / (4 G) + (tr(sigma) / 3)^2 / (2 K)) per initial volume [J/m3].
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real mean = trace(s.elastic) / Real(3);
    return Real(exp(s.log_volume) * (norm_squared(deviator(s.elastic)) / (Real(4) * m.shear_modulus) +
                                     mean * mean / (Real(2) * m.bulk_modulus)));
  }

  /// This function adds to the stress by Hooke's law on the strain increment, and turns it with the spin.
  template <class Real>
  TALUS_HD static void advance(const Elasticity<Real>& m, const Numbers<Real>&, const Increment<Real>& step,
                               MaterialState<Real>& state) {
    const Mat3<Real>& g = step.gradient;
    const Sym3<Real> strain = small_strain(g);
    const Real wxy = Real(0.5) * (g.b.x - g.a.y), wyz = Real(0.5) * (g.c.y - g.b.z), wxz = Real(0.5) * (g.c.x - g.a.z);
    const Sym3<Real> s = state.elastic;
    const Sym3<Real> turned{
        Real(2) * (wxy * s.xy + wxz * s.xz),           Real(2) * (-wxy * s.xy + wyz * s.yz),
        Real(-2) * (wxz * s.xz + wyz * s.yz),          wxy * (s.yy - s.xx) + wxz * s.yz + wyz * s.xz,
        wyz * (s.zz - s.yy) - wxy * s.xz - wxz * s.xy, wxz * (s.zz - s.xx) + wxy * s.yz - wyz * s.xy};
    const Real lame = m.lame();
    state.elastic = s + turned + (strain * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(strain));
  }

  /// The nominal stress of the paper's linear step: stress at the start plus Hooke's law on the strain of the step,
  /// over the volume at the start [Pa]; with `tangent` not null also its derivative by the gradient.
  template <class Real>
  TALUS_HD static Mat3<Real> nominal_stress(const Elasticity<Real>& m, const Numbers<Real>&,
                                            const MaterialState<Real>& start, const Mat3<Real>& g,
                                            PointTangent<Real>* tangent) {
    const Real volume = Real(exp(start.log_volume));
    const Real lame = m.lame();
    const Sym3<Real> strain = small_strain(g);
    const Sym3<Real> s =
        (start.elastic + (strain * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(strain))) * volume;
    if (tangent) {
      for (int q = 0; q < 9; ++q) {
        const bool diagonal = q % 4 == 0;
        tangent->axes[q] = tangent->pull[q] = diagonal ? Real(1) : Real(0);
        tangent->direct[q] = volume * (lame + (diagonal ? Real(2) * m.shear_modulus : Real(0)));
        tangent->pairs[q] = volume * m.shear_modulus;
      }
    }
    return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  }

 private:
  template <class Real>
  TALUS_HD static Sym3<Real> small_strain(const Mat3<Real>& g) {
    return {g.a.x, g.b.y, g.c.z, Real(0.5) * (g.a.y + g.b.x), Real(0.5) * (g.b.z + g.c.y), Real(0.5) * (g.a.z + g.c.x)};
  }
};

}  // namespace talus
