// The numerical scheme that all integrators share: numbers, grid, transfer, step size.
#pragma once

#include "common/recipe/recipe.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

enum class Precision { single_, double_ };
enum class Transfer { apic, flip };
enum class StressUpdate { last, modified };  // USL, MUSL

struct SchemeOptions {
  Precision precision = Precision::double_;
  Mapping mapping = Mapping::terrain_following;
  GroundContact ground_contact = GroundContact::nodes;
  ShapeKind shape = ShapeKind::quadratic;
  Transfer transfer = Transfer::apic;
  double transfer_time = 10;  // CFL steps
  StressUpdate stress_update = StressUpdate::last;
  double damping = 0;  // Cundall's local factor
  double cfl = 0.5;
  double largest_step = 1;  // [s]
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
