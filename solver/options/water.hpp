// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The water between the grains.
#pragma once

#include <optional>
#include <string>

#include "common/recipe/recipe.hpp"
#include "solver/boundary/submersion.hpp"
#include "solver/water/pore_water.hpp"

namespace talus::solver {

struct SolveOptions;

/// A side of the mass that lets water through, or does not.
enum class Drainage { drained, sealed };

/// The keys of [solve.water].
struct WaterOptions {
  std::optional<double> permeability;             ///< at the start [m2]
  std::optional<double> grain_diameter;           ///< that rules permeability and dilatancy [m]
  double solid_fraction = 0.6;                    ///< at the start [-]
  std::optional<double> critical_solid_fraction;  ///< solid fraction that slow shear leads to [-]
  double compressibility = 0.03;                  ///< a [-]
  double reference_stress = 1000;                 ///< sigma_0 [Pa]
  double table_depth = 0;                         ///< of the water table below the surface at the start [m]
  std::optional<double> pressure_ratio;           ///< pressure over load at the start [-]; none: hydrostatic
  double fluid_density = 1000;                    ///< [kg/m3]
  double viscosity = 1e-3;                        ///< [Pa s]
  double fines = 0;                               ///< volume fraction of fines in the fluid [-]
  double suction = 0;                             ///< [Pa]
  Drainage bed = Drainage::sealed, surface = Drainage::drained;
  std::optional<double> level;     ///< elevation of still water around the mass [m]
  double added_mass = 0.5;         ///< share of the displaced water that moves along [-]
  double drag_coefficient = 0.01;  ///< of the water on the surface of the mass [-]

  /// Whether water flows between the grains.
  bool flows() const { return permeability || grain_diameter; }
  /// The density of the fluid with its fines, which are of the grains' mineral [kg/m3].
  double density_of_fluid(double density) const;
  /// The viscosity of the fluid with its fines (Thomas 1965) [Pa s].
  double viscosity_of_fluid() const;
  /// The density of the grains of a mass of this density full of water [kg/m3].
  double density_of_grains(double density) const;
  /// The permeability at the start [m2]: the recipe's, or that of the grains by Kozeny and Carman (Carman 1937).
  double permeability_at_start() const;
  /// The water in a line, for plan and log.
  std::string words(double density) const;

  /// Declares the keys of [solve.water] with defaults, help and what they need of others.
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

/// The still water around the mass, its level an elevation; off where the recipe has none.
Submersion<double> make_submersion(const SolveOptions& options);
/// The water that kernels see; none where the recipe has none.
std::optional<PoreWater<double>> make_water(const SolveOptions& options);

}  // namespace talus::solver
