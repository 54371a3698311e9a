// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Neo-Hookean elasticity, compressible (Simo & Pister 1984; Bonet & Wood 2008): its nominal stress grows with every
// stretch, so that a body that is pulled long does not tear by its law.
#pragma once

#include "solver/material/laws/elastic.hpp"

namespace talus {

/// The law of compressible neo-Hookean elasticity (Simo & Pister 1984).
struct NeoHookean : ElasticLaw<NeoHookean> {
  static constexpr std::string_view name = "neo-hookean";
  static constexpr bool keeps_strain = true, pressure_follows_volume = false;

  /// The law in a line, for plan and log; `elasticity` states density and moduli.
  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (neo-hookean), " + elasticity;
  }
  /// The law in a sentence of the report, "It is ...".
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

}  // namespace talus
