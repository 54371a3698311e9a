// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Hencky elasticity: Kirchhoff stress linear in the logarithmic strain (Hencky 1928; de Souza Neto et al. 2008, ch.
// 13).
#pragma once

#include "solver/material/laws/elastic.hpp"

namespace talus {

/// The law of Hencky elasticity (Hencky 1928).
struct Hencky : ElasticLaw<Hencky> {
  static constexpr std::string_view name = "hencky";
  static constexpr bool keeps_strain = true, pressure_follows_volume = true;
  /// In uniaxial tension the nominal stress E ln(stretch) / stretch falls beyond a stretch of e: what is pulled further
  /// tears.
  static constexpr double largest_strain = 1;

  /// The law in a line, for plan and log; `elasticity` states density and moduli.
  static std::string words(const Options&, const std::string& elasticity) { return "elastic (hencky), " + elasticity; }
  /// The law in a sentence of the report, "It is ...".
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

}  // namespace talus
