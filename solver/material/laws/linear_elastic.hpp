// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Small-strain elasticity, the stress update of the reference paper: Hooke's law on the strain of a step, the stress
// turned with the spin (Jaumann rate). A point keeps its Cauchy stress [Pa] instead of a strain.
#pragma once

#include "solver/material/laws/elastic.hpp"
#include "solver/material/point_tangent.hpp"

namespace talus {

/// The law of small-strain elasticity, as in the reference paper.
struct LinearElastic : ElasticLaw<LinearElastic> {
  static constexpr std::string_view name = "linear-elastic";
  static constexpr bool keeps_strain = false, pressure_follows_volume = false;

  /// The law in a line, for plan and log; `elasticity` states density and moduli.
  static std::string words(const Options&, const std::string& elasticity) {
    return "elastic (small strain), " + elasticity;
  }
  /// The law in a sentence of the report, "It is ...".
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
