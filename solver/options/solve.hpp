// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [solve] table. Every key, its default and its help are in describe() and nowhere else.
#pragma once

#include <string>
#include <vector>

#include "solver/options/bed.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/inflow.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/material.hpp"
#include "solver/options/obstacles.hpp"
#include "solver/options/output.hpp"
#include "solver/options/scheme.hpp"
#include "solver/options/shaking.hpp"
#include "solver/options/stability.hpp"
#include "solver/options/time.hpp"
#include "solver/options/walls.hpp"

namespace talus::solver {

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

  /// The integrator that the recipe asks for, by its name or by a preset.
  Integrator asked_integrator() const {
    const bool dynamic = preset == Preset::reference && integrator != Integrator::quasi_static;
    return dynamic ? Integrator::newmark : integrator;
  }
  /// The integrator of the steps of a flow.
  Integrator flow_integrator() const { return integrator == Integrator::automatic ? flow : integrator; }

  /// The method declares all keys of [solve] and its tables with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// The options with `preset` spelt out: preset = "reference" sets what the reference paper states and leaves the rest
/// alone.
SolveOptions with_preset(SolveOptions options);

}  // namespace talus::solver
