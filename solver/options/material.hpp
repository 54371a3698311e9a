// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the mass is made of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/material/material.hpp"

namespace talus::solver {

/// Whether Young's modulus is the one given, or the lowest that leaves the flow unchanged (docs/notes/integrators.md).
enum class StiffnessKind { as_given, automatic };

/// The usual strain under the dynamic pressure of the flow to which a chosen stiffness holds.
inline constexpr double default_stiffness_strain = 0.02;

/// The keys of [solve.material]: those of every material, then those of the laws, declared in solver/material/laws.
struct MaterialOptions : OptionsOfLaws<MaterialLaws> {
  MaterialModel model = MaterialModel::drucker_prager;
  double density = 2000;        ///< [kg/m3]
  double youngs_modulus = 1e7;  ///< [Pa]
  StiffnessKind stiffness = StiffnessKind::as_given;
  double stiffness_strain = default_stiffness_strain;  ///< that the dynamic pressure may cause, where it is chosen [-]
  double poisson_ratio = 0.25;                         ///< [-]

  /// Calls visit(Law{}, options of that law) for the chosen law, and returns what that returns.
  template <class Visit>
  auto with_law(const Visit& visit) const {
    return visit_law(model, [&](auto law) { return visit(law, options_of<decltype(law)>()); });
  }
  std::vector<std::string> idle() const;  ///< the keys of numbers that are given for another law than the chosen one
  /// Whether strength falls as the material shears.
  bool softens() const;
  /// Whether shear changes the volume of the material.
  bool dilates() const;
  /// The coefficient of friction inside, in slow shear; 0 where the strength is no friction [-].
  double internal_friction() const;
  /// Whether implicit steps take the law.
  bool steps_implicitly() const;
  /// Whether what the material does leaves its stiffness free, as that of a flow does.
  bool stiffness_is_free() const;
  /// Whether one part of the mass may hang on another: in elastic solids, and in sand with a tension cut-off.
  bool holds_tension() const;
  std::string name() const;
  /// Whether the volume change alone decides the pressure, as B-bar needs.
  bool pressure_follows_volume() const;
  /// The material in a line, for plan and log.
  std::string words() const;
  /// The material in a sentence of the report, "It is ...".
  std::string sentence() const;

  /// Declares the keys of a table of a material; `table` is what messages call it.
  void describe(recipe::Visitor& v, const std::string& table);
};

/// The keys of [[solve.part]]: a release of another material than [solve.material].
struct PartOptions {
  std::string release;
  MaterialOptions material;
  void describe(recipe::Visitor& v);
};

/// The material of the mass, and of its parts that are of another one.
struct MassOptions {
  std::vector<PartOptions> parts;
  MaterialOptions material;

  const MaterialOptions& material_of(const std::string& release) const;
  bool every_material(const std::function<bool(const MaterialOptions&)>& is) const {
    return !any_material([&](const MaterialOptions& m) { return !is(m); });
  }
  /// Whether one of the materials is such.
  bool any_material(const std::function<bool(const MaterialOptions&)>& is) const;
  /// Whether parts have another density than the rest.
  bool densities_differ() const {
    return any_material([&](const MaterialOptions& m) { return m.density != material.density; });
  }

  /// Declares [solve.material] and [[solve.part]].
  void describe(recipe::Visitor& v);
};

/// The material that kernels see: moduli and wave speed from a recipe's words, and the numbers of its law; softening is
/// for a grid whose cells have this least `side` [m].
template <class Real>
Material<Real> make_material(const MaterialOptions& options, double side = 0);

/// The material of [solve.material] first, then those of the parts, for cells of this size [m].
template <class Real>
Materials<Real> make_materials(const MassOptions& options, double spacing, double layer_height);

/// The fastest wave of any of the materials [m/s].
double fastest_wave(const MassOptions& options);

}  // namespace talus::solver
