// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Materials as kernels see them, and what their laws make of a point: stress, energy, the state after a step.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

#include "solver/material/law.hpp"

namespace talus {

template <class Real, class Laws>
struct NumbersOfLaws;
/// The numbers of all laws side by side; those of another law than the material's are not read.
template <class Real, class... Laws>
struct NumbersOfLaws<Real, LawList<Laws...>> : Laws::template Numbers<Real>... {};

/// A material: its law, elasticity and the law's numbers.
template <class Real, class Laws = MaterialLaws>
struct Material : Elasticity<Real>, NumbersOfLaws<Real, Laws> {
  MaterialModel model = static_cast<MaterialModel>(0);

  /// The method returns visit(Law{}, numbers of that law) for the law of the material.
  template <class Visit>
  TALUS_HD auto with_law(const Visit& visit) const {
    return visit_law<Laws>(model, [&](auto law) { return visit(law, numbers_of<decltype(law)>()); });
  }
  /// The method calls visit(Law{}, numbers of that law) for the law of the material; `visit` may change them.
  template <class Visit>
  TALUS_HD void change_law(const Visit& visit) {
    visit_law<Laws>(model, [&](auto law) { visit(law, numbers_of<decltype(law)>()); });
  }
  /// Whether a point's `elastic` is its logarithmic strain.
  TALUS_HD bool keeps_strain() const {
    return visit_law<Laws>(model, [](auto law) { return decltype(law)::keeps_strain; });
  }
  /// Whether a point may hang on the one above it: in elastic solids, and in sand with a tension cut-off.
  TALUS_HD bool holds_tension() const {
    return with_law([](auto law, const auto& numbers) {
      if constexpr (requires { numbers.tension; }) {
        return numbers.tension > Real(0);
      } else {
        return !decltype(law)::stiffness_is_free;
      }
    });
  }

  /// The numbers of a law, which count while that is the material's.
  template <class Law>
  TALUS_HD const typename Law::template Numbers<Real>& numbers_of() const {
    return *this;
  }
  template <class Law>
  TALUS_HD typename Law::template Numbers<Real>& numbers_of() {
    return *this;
  }
};

inline constexpr int most_materials = 8;

/// The material after it has yielded by this plastic shear strain (T15c).
template <class Real, class Laws>
TALUS_HD Material<Real, Laws> softened(Material<Real, Laws> m, Real plastic_shear) {
  m.change_law([&](auto, auto& numbers) { numbers.soften(plastic_shear); });
  return m;
}

/// Gives a material the strength that water leaves it: by friction (T50g), or of mud
/// which has taken in so much water, as ln of the volume (T28a).
template <class Real, class Laws>
TALUS_HD void wet(Material<Real, Laws>& m, Real strength, Real log_volume) {
  m.change_law([&](auto, auto& numbers) {
    if constexpr (requires { numbers.bear(strength); }) numbers.bear(strength);
    if constexpr (requires { numbers.take_in(log_volume); }) numbers.take_in(log_volume);
  });
}

/// This function takes in water of this share of the volume: a stretch across the bed without stress, which is not
/// elastic (T50h). `normal`: of the bed.
template <class Real>
TALUS_HD void take_water(MaterialState<Real>& s, const Vec3<Real>& normal, Real share) {
  const Vec3<Real> n = normal * share;
  s.elastic.xx -= n.x * normal.x;
  s.elastic.yy -= n.y * normal.y;
  s.elastic.zz -= n.z * normal.z;
  s.elastic.xy -= n.x * normal.y;
  s.elastic.yz -= n.y * normal.z;
  s.elastic.xz -= n.x * normal.z;
  s.plastic_log_volume += share;
}

/// Prepares a material for implicit steps: the pressure over which the tip of a cone is rounded [Pa] (T15b).
template <class Real, class Laws>
void prepare_for_newton(Material<Real, Laws>& m, Real apex) {
  m.change_law([&](auto, auto& numbers) { numbers.round_tip(apex); });
}

/// The materials of a scene, of the laws `Laws`. A scene of one that does not soften has no arrays on its points, and
/// they all take the first.
template <class Real, class Laws = MaterialLaws>
struct Materials {
  using List = Laws;
  Material<Real, Laws> list[most_materials];

  /// The material of point p. `which` and `plastic_shear` are the points' arrays; null where the scene needs none.
  TALUS_HD Material<Real, Laws> of(const int* which, const Real* plastic_shear, int p) const {
    const Material<Real, Laws>& m = which ? list[which[p]] : list[0];
    return plastic_shear ? softened(m, plastic_shear[p]) : m;
  }
  /// The same, where water bears a part of the load.
  template <class Points>
  TALUS_HD Material<Real, Laws> of(const Points& points, int p) const {
    Material<Real, Laws> m = of(points.material, points.plastic_shear, p);
    if (points.water_strength) wet(m, points.water_strength[p], points.plastic_log_volume[p]);
    return m;
  }
  /// The density of point p [kg/m3].
  TALUS_HD Real density(const int* which, int p) const { return which ? list[which[p]].density : list[0].density; }

  template <class... Known>
  bool all_in(LawList<Known...>) const {
    for (const Material<Real, Laws>& m : list) {
      if (!((m.model == model_of<Known, Laws>) || ...)) return false;
    }
    return true;
  }
  /// The same materials for kernels of the laws in a list, which must hold those of all of them.
  template <class... Known>
  Materials<Real, LawList<Known...>> only(LawList<Known...>) const {
    Materials<Real, LawList<Known...>> some;
    for (int n = 0; n < most_materials; ++n) {
      Material<Real, LawList<Known...>>& m = some.list[n];
      static_cast<Elasticity<Real>&>(m) = list[n];
      ((m.template numbers_of<Known>() = list[n].template numbers_of<Known>()), ...);
      list[n].with_law([&](auto law, const auto&) {
        using Law = decltype(law);
        if constexpr ((std::is_same_v<Law, Known> || ...)) m.model = model_of<Law, LawList<Known...>>;
      });
    }
    return some;
  }
};

/// The sets of laws that kernels are compiled for, in the order in which they are tried; the last one holds all laws.
/// Kernels of few laws take fewer registers. Each set adds the kernels of a step once more.
using CompiledLaws = std::tuple<LawList<DruckerPrager>, MaterialLaws>;

/// This function calls run(materials) for kernels that evaluate the law at every point, with the first of the compiled
/// sets that holds the laws of all materials.
template <std::size_t set = 0, class Real, class Run>
void with_laws_of(const Materials<Real>& all, const Run& run) {
  if constexpr (set + 1 == std::tuple_size_v<CompiledLaws>) {
    run(all);
  } else {
    constexpr std::tuple_element_t<set, CompiledLaws> laws;
    if (all.all_in(laws)) return run(all.only(laws));
    with_laws_of<set + 1>(all, run);
  }
}

/// The Kirchhoff stress tau = J sigma [Pa].
template <class Real, class Laws>
TALUS_HD Sym3<Real> kirchhoff_stress(const Material<Real, Laws>& m, const MaterialState<Real>& s) {
  return m.with_law([&](auto law, const auto& numbers) { return law.stress(m, numbers, s); });
}

/// The elastic energy per initial volume [J/m3].
template <class Real, class Laws>
TALUS_HD Real elastic_energy(const Material<Real, Laws>& m, const MaterialState<Real>& s) {
  return m.with_law([&](auto law, const auto& numbers) { return law.energy(m, numbers, s); });
}

/// The speed of waves in a point of this state [m/s]: that of the material at rest, or where stretch stiffens its law
/// (Law::stiffening), more.
template <class Real, class Laws>
TALUS_HD Real wave_speed(const Material<Real, Laws>& m, const MaterialState<Real>& s) {
  return m.with_law([&](auto law, const auto& numbers) {
    if constexpr (requires { law.stiffening(m, numbers, s); }) {
      return m.wave_speed * Real(sqrt(law.stiffening(m, numbers, s)));
    } else {
      return m.wave_speed;
    }
  });
}

/// This function advances the state over a step of `seconds` with displacement gradient g = dt grad v, (T14), and the
/// mean volume change (T17b) where that is on.
template <class Real, class Laws>
TALUS_HD void advance_material(const Material<Real, Laws>& m, const Mat3<Real>& g, std::type_identity_t<Real> seconds,
                               MaterialState<Real>& s, const MeanVolume<Real>& mean = {}) {
  const Increment<Real> step(g, seconds, mean);
  s.log_volume += step.volume;
  if (s.log_volume > Real(widest_opening)) s.log_volume = Real(widest_opening);
  if (m.keeps_strain()) s.elastic = advance_strain(s.elastic, g);
  m.with_law([&](auto law, const auto& numbers) {
    if constexpr (law.keeps_strain) {
      law.settle(m, numbers, step, s);
    } else {
      law.advance(m, numbers, step, s);
    }
  });
}

/// This function returns a state after a step in equal pieces (T14b).
template <class Real, class Laws>
TALUS_RARE MaterialState<Real> advance_in_pieces(const Material<Real, Laws> m, const Mat3<Real> g, int pieces,
                                                 Real seconds, MaterialState<Real> s) {
  const Real part = Real(1) / Real(pieces);
  Real slip = 0;
  for (int n = 0; n < pieces; ++n) {
    advance_material(m, Mat3<Real>{g.a * part, g.b * part, g.c * part}, seconds * part, s);
    slip += s.plastic_shear;
  }
  s.plastic_shear = slip;
  return s;
}

/// This function takes a share of a point's stress away; what has opened stays open.
template <class Real, class Laws>
TALUS_HD void forget_stress(const Material<Real, Laws>& m, Real kept, MaterialState<Real>& s) {
  s.elastic = s.elastic * kept;
  const bool by_volume = visit_law<Laws>(m.model, [](auto law) { return decltype(law)::pressure_follows_volume; });
  const Real pressed = s.log_volume - s.plastic_log_volume;
  if (by_volume && pressed < Real(0)) s.log_volume = s.plastic_log_volume + kept * pressed;
}

}  // namespace talus
