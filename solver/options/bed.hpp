// The friction between the mass and its bed.
#pragma once

#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/boundary/base_friction.hpp"

namespace talus::solver {

struct SolveOptions;

struct BaseOptions {
  FrictionLaw law = FrictionLaw::coulomb;
  double friction_angle = 20;  // [deg]
  double peak_coefficient = 0.7;
  double steady_coefficient = 0.23;
  double characteristic_speed = 1;  // [m/s]
  double turbulence = 500;          // voellmy: xi [m/s2]
  double cohesion = 0;              // [Pa]
  double pore_pressure_ratio = 0;   // water's part of the normal stress [-]
  void describe(recipe::Visitor& v);
  void check(std::vector<Fault>& faults) const;
  /// The number that the recipe calls by this name, null where it has none that a raster can give.
  double* named(const std::string& key);
  bool uses(const std::string& key) const;  ///< whether the law looks at it
};

/// The bed's law with the same numbers everywhere.
template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options);

}  // namespace talus::solver
