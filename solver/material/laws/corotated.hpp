// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Corotated elasticity: stress linear in the stretch, P = R (2G (U - I) + lambda tr(U - I) I), so that a bar keeps
// force = E times engineering strain (Chao et al. 2010).
#pragma once

#include "solver/material/laws/elastic.hpp"

namespace talus {

/// The law of corotated elasticity (Chao et al. 2010).
struct Corotated : ElasticLaw<Corotated> {
  static constexpr std::string_view name = "corotated";
  static constexpr bool keeps_strain = true, pressure_follows_volume = false;

  /// The law in a line, for plan and log; `elasticity` states density and moduli.
  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (corotated), " + elasticity;
  }
  /// The law in a sentence of the report, "It is ...".
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

}  // namespace talus
