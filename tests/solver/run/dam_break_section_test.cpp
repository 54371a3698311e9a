// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A section at the place of a dam that breaks over a dry bed, against Ritter's closed form.
#include <cmath>
#include <cstdio>
#include <vector>

#include "solver/options/solve.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

constexpr double dam_depth = 1, gravity = 9.81, dam_density = 1000;

/// Mean of discharge over width [m2/s] and of momentum flux over width [N/m] at the dam, from 2 to 5 s.
struct AtTheDam {
  double discharge = 0, momentum = 0, depth = 0;
};

AtTheDam break_dam(On on, int layers) {
  const double layer = dam_depth / layers, cell = 2 * layer, reservoir = 20, west = 20, east = 34;
  Domain d = ground(static_cast<int>((west + east) / cell), 9, cell, layer, [](double, double) { return 0.0; });
  d.grid.west = -west - 0.5 * cell;
  d.grid.south = -3.5 * cell;  // nodes at the walls
  for (Raster* r : {&d.terrain, &d.before, &d.release_thickness}) r->grid = d.grid;
  fill(d, {-reservoir + 4 * cell, 0, 0, cell, 0, dam_depth});
  SolveOptions o;
  o.integrator = Integrator::explicit_;
  o.material.model = MaterialModel::herschel_bulkley;
  o.material.density = dam_density;
  o.material.youngs_modulus = 1e6;
  o.material.poisson_ratio = 0.45;
  o.material.yield_stress = 0;
  o.material.consistency = 0.1;
  o.base.law = FrictionLaw::none;
  o.walls = {{Axis::x, -reservoir + 4 * cell, Side::above, WallKind::roller},
             {Axis::y, 0, Side::above, WallKind::roller},
             {Axis::y, cell, Side::below, WallKind::roller}};
  o.sections = {{.name = "dam", .x = {0, 0}, .y = {4 * cell, -2 * cell}}};
  const RunHistory h = recorded(d, o, on, 5, 0.25);
  AtTheDam mean;
  const auto &time = h.at("time_s").values, &flow = h.at("section_dam_discharge_m3_s").values,
             &force = h.at("section_dam_momentum_flux_N").values, &area = h.at("section_dam_area_m2").values;
  int rows = 0;
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (time[row] <= 2) continue;
    mean.discharge -= flow[row] / cell;  // walked from the north to the south, the flow comes from the right
    mean.momentum += force[row] / cell;
    mean.depth += area[row] / cell;
    ++rows;
  }
  return {mean.discharge / rows, mean.momentum / rows, mean.depth / rows};
}

class DamBreak : public InEachPlace {};

/// Ritter (1892): over a dry bed without friction the depth at the dam is 4/9 of that behind it, the speed 2/3
/// sqrt(g h), so that the discharge is 8/27 h sqrt(g h) and the momentum flux 16/81 rho g h^2, from the start until the
/// wave comes back from the end of the reservoir. Found with 4 and 8 layers: discharge 0.2 and 0.1 % less, momentum
/// flux 2.8 and 1.6 % less, for the depth at the dam is 2.3 and 1.2 % more: shallow water knows no vertical
/// acceleration, and points that carry their momentum through a grid lose some of it.
TEST_P(DamBreak, discharges_at_the_dam_what_Ritter_says) {
  const double discharge = 8.0 / 27 * dam_depth * std::sqrt(gravity * dam_depth);
  const double momentum = 16.0 / 81 * dam_density * gravity * dam_depth * dam_depth;
  double coarse = 1;
  for (const auto& [layers, tolerance] : {std::pair{4, 0.04}, std::pair{8, 0.025}}) {
    const AtTheDam found = break_dam(GetParam(), layers);
    std::printf("  dam break, %d layers: %.4f m2/s (%.4f), %.0f N/m (%.0f), depth %.3f m (%.3f)\n", layers,
                found.discharge, discharge, found.momentum, momentum, found.depth, 4.0 / 9 * dam_depth);
    EXPECT_NEAR(found.discharge, discharge, 0.01 * discharge) << layers;
    EXPECT_NEAR(found.momentum, momentum, tolerance * momentum) << layers;
    const double error = std::abs(found.momentum / momentum - 1);
    EXPECT_LT(error, coarse) << "refining helps";
    coarse = error;
  }
}

TALUS_IN_EACH_PLACE(DamBreak);

}  // namespace
}  // namespace talus::solver::testing
