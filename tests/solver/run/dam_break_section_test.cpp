// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A section at the place of a dam that breaks over a dry bed, and gauges around it, against Ritter's closed form.
#include <cstdio>

#include <fmt/format.h>

#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

constexpr double dam_depth = 1, gravity = 9.81, dam_density = 1000;

/// Mean of discharge over width [m2/s] and of momentum flux over width [N/m] at the dam, from 2 to 5 s.
struct AtTheDam {
  double discharge = 0, momentum = 0, depth = 0;
};

/// The middle of the flume, from the dam [m]: in the reservoir, at the dam and below it.
constexpr double gauge_places[] = {-4, 0, 4};

/// A flume between smooth walls, `wide` cells wide; the gauges stand in its middle.
RunHistory break_dam(On on, int layers, int wide = 1) {
  const double layer = dam_depth / layers, cell = 2 * layer, reservoir = 20, west = 20, east = 34;
  const double width = wide * cell;
  Domain d = ground(static_cast<int>((west + east) / cell), wide + 8, cell, layer, [](double, double) { return 0.0; });
  d.grid.west = -west - 0.5 * cell;
  d.grid.south = -3.5 * cell;  // nodes at the walls
  for (Raster* r : {&d.terrain, &d.before, &d.release_thickness}) r->grid = d.grid;
  fill(d, {-reservoir + 4 * cell, 0, 0, width, 0, dam_depth});
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
             {Axis::y, width, Side::below, WallKind::roller}};
  o.sections = {{.name = "dam", .line = {{0, width + 3 * cell}, {0, -2 * cell}}}};
  for (const double x : gauge_places) o.gauges.push_back({.name = fmt::format("at{:g}", x), .x = x, .y = 0.5 * width});
  return recorded(d, o, on, 5, 0.25);
}

AtTheDam at_the_dam(const RunHistory& h, int layers) {
  const double cell = 2 * dam_depth / layers;
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
    const AtTheDam found = at_the_dam(break_dam(GetParam(), layers), layers);
    std::printf("  dam break, %d layers: %.4f m2/s (%.4f), %.0f N/m (%.0f), depth %.3f m (%.3f)\n", layers,
                found.discharge, discharge, found.momentum, momentum, found.depth, 4.0 / 9 * dam_depth);
    EXPECT_NEAR(found.discharge, discharge, 0.01 * discharge) << layers;
    EXPECT_NEAR(found.momentum, momentum, tolerance * momentum) << layers;
    const double error = std::abs(found.momentum / momentum - 1);
    EXPECT_LT(error, coarse) << "refining helps";
    coarse = error;
  }
}

/// Ritter (1892): at x from the dam and t after it broke the depth is (2 c - x/t)^2 / 9 g and the speed 2/3 (c + x/t),
/// c = sqrt(g h) behind the dam. From 2 to 5 s each is held to 5 % of the depth behind the dam, and of c: found 4.2 %
/// and 3.6 % in the reservoir at first, where vertical accelerations, which shallow water does not know, round the
/// corner that the wave begins with; they fade as it gets longer. At 5 s it is held to 2.5 % (found 1.9 and 1.7 %; the
/// depth below the dam swings by 2 % as points pass the gauge). Four cells of width: at the walls the mass of a cell
/// counts half.
TEST_P(DamBreak, has_gauges_with_the_depths_and_speeds_of_Ritter) {
  const double c = std::sqrt(gravity * dam_depth);
  const RunHistory h = break_dam(GetParam(), 4, 4);
  const auto& time = h.at("time_s").values;
  for (const double x : gauge_places) {
    const std::string name = fmt::format("gauge_at{:g}_", x);
    const auto &thickness = h.at(name + "thickness_m").values, &speed = h.at(name + "speed_m_s").values,
               &surface = h.at(name + "surface_m").values;
    for (std::size_t row = 0; row < time.size(); ++row) {
      const double t = time[row];
      EXPECT_NEAR(surface[row], thickness[row], 1e-9) << "the ground is at 0";
      if (t <= 2) continue;
      const double depth = std::pow(2 * c - x / t, 2) / (9 * gravity), velocity = 2.0 / 3 * (c + x / t);
      const double within = t < 4.9 ? 0.05 : 0.025;
      EXPECT_NEAR(thickness[row], depth, within * dam_depth) << name << " at " << t << " s";
      EXPECT_NEAR(speed[row], velocity, within * c) << name << " at " << t << " s";
    }
  }
}

TALUS_IN_EACH_PLACE(DamBreak);

}  // namespace
}  // namespace talus::solver::testing
