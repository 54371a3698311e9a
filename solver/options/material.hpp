// What the mass is made of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/material/material.hpp"

namespace talus::solver {

enum class StiffnessKind { as_given, automatic };
enum class Cone { compression, extension, plane_strain };

struct MaterialOptions {
  MaterialModel model = MaterialModel::drucker_prager;
  double density = 2000;        // [kg/m3]
  double youngs_modulus = 1e7;  // [Pa]
  StiffnessKind stiffness = StiffnessKind::as_given;
  bool stiffness_check = false;        // run again, twice as stiff
  double poisson_ratio = 0.25;         // [-]
  double friction_angle = 30;          // [deg]
  double cohesion = 0;                 // [Pa]
  double dilatancy_angle = 0;          // [deg]
  double tension_cutoff = 0;           // [Pa]
  double pore_pressure_ratio = 0;      // water's part of the mean stress [-]
  double softening_slip = 0;           // over which strength falls to the residual one [m]; 0: it does not
  double residual_friction_angle = 0;  // [deg]
  double residual_cohesion = 0;        // [Pa]
  Cone cone = Cone::compression;
  bool dilates() const { return model == MaterialModel::drucker_prager && dilatancy_angle > 0; }
  bool softens() const { return model == MaterialModel::drucker_prager && softening_slip > 0; }
  void describe(recipe::Visitor& v);
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

/// Moduli, wave speed and cone from a recipe's words. Cone fitted to Mohr-Coulomb in triaxial compression or extension
/// (Chen & Mizuno 1990, table 4.1), or in plane strain for the flow its own dilatancy angle gives (the table's fit
/// where that is the friction angle).
template <class Real>
Material<Real> make_material(const MaterialOptions& options);

/// That of [solve.material] first, then those of the parts. Softening goes by slip: a band of shear is one cell wide,
/// so that the strain over which strength falls is the slip over the least side of a cell (Pietruszczak & Mroz 1981),
/// and results do not hang on the grid.
template <class Real>
Materials<Real> make_materials(const MassOptions& options, double spacing, double layer_height);

/// The fastest wave of any of them [m/s].
double fastest_wave(const MassOptions& options);

}  // namespace talus::solver
