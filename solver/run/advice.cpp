// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/advice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/map/usual_reach.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/run/energy_line.hpp"
#include "solver/run/stiffness.hpp"
#include "solver/scene/make_inflow.hpp"

namespace talus::solver {
namespace {

constexpr double to_degrees = 180 / std::numbers::pi;
constexpr double fewest_points = 4;  // in a cell: with two along each of two axes a flow still has no gaps
constexpr double longer_steps = 3;   // what a lower stiffness must bring to be spoken of

double released_volume(const Domain& domain, const SolveOptions& o) {
  double volume = 0;
  for (const InflowSummary& inflow : inflow_summaries(domain, o)) volume += inflow.volume;
  for (std::size_t n = 0; n < domain.points.size(); ++n)
    if (domain.points.release[n] >= domain.erodible) volume += domain.points.volume[n];
  return volume;
}

void advise_on_points(const Domain& domain, Advice& lines) {
  double volume = 0;
  for (const double v : domain.points.volume) volume += v;
  const double cell = domain.grid.cell * domain.grid.cell * domain.layer_height;
  const double in_a_cell = volume > 0 ? static_cast<double>(domain.points.size()) * cell / volume : fewest_points;
  if (in_a_cell >= fewest_points) return;
  lines.emplace_back("points", fmt::format("a cell holds {:.2g} material points: a flow that spreads gets gaps. Put "
                                           "points_per_cell = [2, 2, 2] into [preprocess.grid]",
                                           in_a_cell));
}

void advise_on_stiffness(const Domain& domain, const SolveOptions& o, Advice& lines) {
  if (!abilities_of(o.integrator).obey_cfl || !o.material.stiffness_is_free()) return;
  const StiffnessDemand demand = lowest_stiffness(domain, o);
  const double shorter = demand.modulus > 0 ? std::sqrt(o.material.youngs_modulus / demand.modulus) : 0;
  if (!(shorter >= longer_steps) || !(demand.speed > 0)) return;
  lines.emplace_back(
      "stiffness", fmt::format("youngs_modulus_Pa = {:.3g} makes steps up to {:.2g} times shorter than the flow needs: "
                               "{:.2g} Pa would do. Put stiffness = \"auto\" into [solve.material]",
                               o.material.youngs_modulus, shorter, demand.modulus));
}

/// The coefficient of a bed of one angle [-]; 0 where the law is another, or the angle changes from place to place.
double coulomb_coefficient(const Domain& domain, const SolveOptions& o) {
  const auto by_place = [](const auto& raster) { return raster.first == "friction_angle_deg"; };
  if (o.base.law != FrictionLaw::coulomb || std::any_of(domain.bed.begin(), domain.bed.end(), by_place)) return 0;
  const auto friction = make_base_friction<double>(o);
  return friction.coefficient(friction.uniform, {.speed = 0, .normal_stress = 1e5, .duration = 0, .load = 1e4});
}

void advise_on_friction(const Domain& domain, const SolveOptions& o, Advice& lines) {
  const double coefficient = coulomb_coefficient(domain, o), volume = released_volume(domain, o);
  const ReachBounds usual = usual_reach(volume);
  if (!(coefficient > 0) || !(usual.high > 0)) return;
  if (coefficient >= usual.low && coefficient <= usual.high) return;
  std::string sources;
  for (const ReachRegression& one : reach_regressions())
    if (volume >= one.from_volume)
      sources += fmt::format("{}{:.2f} ({}, {})", sources.empty() ? "" : ", ", one.tangent(volume), one.source, one.of);
  lines.emplace_back(
      "friction",
      fmt::format("the bed's friction of {:.2f} ({:.1f} deg) is far from the height over length of fall that is usual "
                  "for {:.3g} m3: {}; beyond half and twice of it there is hardly any. Look at [solve.base] "
                  "friction_angle_deg again: {:.0f} to {:.0f} deg",
                  coefficient, std::atan(coefficient) * to_degrees, volume, sources, std::atan(usual.low) * to_degrees,
                  std::atan(usual.high) * to_degrees));
}

/// What is as fast as the energy line allows takes this long to be braked by its bed on level ground, and has been
/// sped up before.
void advise_on_end(const Domain& domain, const SolveOptions& o, Advice& lines) {
  if (!abilities_of(o.integrator).carry_inertia || !o.loads.empty() || !o.walls.empty()) return;
  const EnergyLine line = energy_line_of(domain, o);
  const double g = std::hypot(o.gravity[0], o.gravity[1], o.gravity[2]);
  if (!(line.friction > 0.02) || !(g > 0)) return;
  const double speed = std::sqrt(2 * g * line.largest_head(domain.terrain)), braking = speed / (g * line.friction);
  if (o.end_time >= braking) return;
  lines.emplace_back("end-time",
                     fmt::format("end_time_s = {:.3g} is likely before rest: the energy line allows {:.3g} m/s, and "
                                 "the bed alone takes {:.3g} s to brake that. Put end_time_s = {:.2g} and "
                                 "stop_kinetic_fraction = 0.001 into [solve]: the run stops by itself at rest",
                                 o.end_time, speed, braking, 3 * braking));
}

}  // namespace

Advice advice(const Domain& domain, const SolveOptions& options) {
  Advice lines;
  advise_on_points(domain, lines);
  advise_on_stiffness(domain, options, lines);
  advise_on_friction(domain, options, lines);
  advise_on_end(domain, options, lines);
  return lines;
}

}  // namespace talus::solver
