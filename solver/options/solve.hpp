// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [solve] table. Every key, its default and its help are in describe() and nowhere else.
#pragma once

#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/options/bed.hpp"
#include "solver/options/erosion.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/inflow.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/material.hpp"
#include "solver/options/output.hpp"
#include "solver/options/scheme.hpp"
#include "solver/options/water.hpp"

namespace talus::solver {

struct SolveOptions;

/// The keys of [solve.stability].
struct StabilityOptions {
  bool factor_of_safety = false;  ///< find it, instead of a run in time
  double tolerance = 0.005;       ///< width of the bracket over its lower end [-]
  double largest_factor = 20;     ///< factor beyond which the search ends [-]; no key
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

/// The keys of [solve] itself by their concern, then its tables.
struct SolveOptions : TimeOptions, SchemeOptions, GravityOptions, OutputOptions, MassOptions {
  ImplicitOptions implicit;
  StabilityOptions stability;
  std::vector<WallOptions> walls;
  std::vector<ObstacleOptions> obstacles;
  std::vector<LoadOptions> loads;
  std::vector<InflowOptions> inflows;
  ShakingOptions shaking;
  BaseOptions base;
  WaterOptions water;
  ErosionOptions erosion;

  /// The integrator that the recipe asks for, by its name or by a preset.
  Integrator asked_integrator() const {
    const bool dynamic = preset == Preset::reference && integrator != Integrator::quasi_static;
    return dynamic ? Integrator::newmark : integrator;
  }
  Integrator flow_integrator() const { return integrator == Integrator::automatic ? flow : integrator; }
  /// The length of a flow's steps over the CFL step: as given, or what those steps take by themselves.
  double step_over_cfl() const;

  /// Declares all keys of [solve] and its tables with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// The options with `preset` spelt out: preset = "reference" sets what the reference paper states and nothing else.
SolveOptions with_preset(SolveOptions options);

}  // namespace talus::solver
