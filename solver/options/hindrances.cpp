// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/hindrances.hpp"

#include <fmt/format.h>

#include "solver/options/solve.hpp"

namespace talus::solver {

Hindrance beyond_columns(const SolveOptions& o) {
  for (const WallOptions& wall : o.walls)
    if (wall.axis == Axis::z && wall.material_is == Side::below)
      return {"a [[solve.wall]] across z above the material", "columns are solved for from their foot upwards"};
  return {};
}

double longest_by_columns(const SolveOptions& o) {
  return o.any_material([](const MaterialOptions& m) { return m.holds_tension(); }) ? 1 : 1.5;
}

Hindrance law_beyond_newton(const SolveOptions& o) {
  Hindrance law;
  o.any_material([&](const MaterialOptions& m) {
    if (m.steps_implicitly()) return false;
    law = {fmt::format("model = \"{}\"", m.name()),
           "its stress depends on the rate of shear, and Newton's iterations have not been shown to converge with it"};
    return true;
  });
  return law;
}

Hindrance beyond_rest(const SolveOptions& o) {
  if (Hindrance law = law_beyond_newton(o)) return law;
  if (o.base.separation != Separation::free)
    return {fmt::format("[solve.base] separation = \"{}\"", o.base.separation_name()),
            "Newton's iterations free a base node whose reaction would pull"};
  if (o.deterministic) return {"[solve] deterministic = true", "sums of implicit steps are made in any order on a GPU"};
  if (o.energy_budget) return {"[solve] energy_budget = true", "losses are counted in steps of a flow alone"};
  return {};
}

}  // namespace talus::solver
