// What the mass is made of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/material/material.hpp"

namespace talus::solver {

enum class StiffnessKind { as_given, automatic };

/// The keys of [solve.material]: those of every material, then those of the laws (solver/material/laws), each law's
/// declared in its header.
struct MaterialOptions : OptionsOfLaws<MaterialLaws> {
  MaterialModel model = MaterialModel::drucker_prager;
  double density = 2000;        // [kg/m3]
  double youngs_modulus = 1e7;  // [Pa]
  StiffnessKind stiffness = StiffnessKind::as_given;
  bool stiffness_check = false;  // run again, twice as stiff
  double poisson_ratio = 0.25;   // [-]

  /// visit(Law{}, options of that law) for the chosen law.
  template <class Visit>
  auto with_law(const Visit& visit) const {
    return visit_law(model, [&](auto law) { return visit(law, options_of<decltype(law)>()); });
  }
  /// Whether strength falls as the material shears, and whether shear changes its volume.
  bool softens() const;
  bool dilates() const;
  /// Whether the volume change alone decides the pressure, as B-bar needs.
  bool pressure_follows_volume() const;
  /// The material in a line, for plan and log.
  std::string words() const;
  /// The material in a sentence of the report, "It is ...".
  std::string sentence() const;

  void describe(recipe::Visitor& v);
  /// `table` is how messages call the table that says it.
  void check(const std::string& table, std::vector<Fault>& faults) const;
};

/// A release of another material than [solve.material].
struct PartOptions {
  std::string release;
  MaterialOptions material;
  void describe(recipe::Visitor& v);
};

/// The material of the mass, and of its parts that are of another one.
struct MassOptions {
  std::vector<PartOptions> parts;
  MaterialOptions material;

  bool every_material(const std::function<bool(const MaterialOptions&)>& is) const {
    return !any_material([&](const MaterialOptions& m) { return !is(m); });
  }
  bool any_material(const std::function<bool(const MaterialOptions&)>& is) const;
  bool densities_differ() const {
    return any_material([&](const MaterialOptions& m) { return m.density != material.density; });
  }

  void describe(recipe::Visitor& v);
  void check(std::vector<Fault>& faults) const;
};

/// Moduli and wave speed from a recipe's words, and the numbers of its law; softening for a grid whose cells have this
/// least `side` [m].
template <class Real>
Material<Real> make_material(const MaterialOptions& options, double side = 0);

/// That of [solve.material] first, then those of the parts.
template <class Real>
Materials<Real> make_materials(const MassOptions& options, double spacing, double layer_height);

/// The fastest wave of any of them [m/s].
double fastest_wave(const MassOptions& options);

}  // namespace talus::solver
