// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe could do better.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "common/map/usual_reach.hpp"
#include "common/stage/findings.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/plan/checks.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/stiffness.hpp"

namespace talus::solver {
namespace {

constexpr double to_degrees = 180 / std::numbers::pi;
constexpr double fewest_points = 4;  // in a cell: with two along each of two axes a flow still has no gaps
constexpr double longer_steps = 3;   // what a lower stiffness must bring to be spoken of

double released_volume(const Plan& plan) {
  const Domain& domain = *plan.domain;
  double volume = 0;
  for (const InflowSummary& inflow : plan.scene.inflow.summaries) volume += inflow.volume;
  for (std::size_t n = 0; n < domain.points.size(); ++n)
    if (domain.points.release[n] >= domain.erodible) volume += domain.points.volume[n];
  return volume;
}

void advise_on_points(const Domain& domain) {
  double volume = 0;
  for (const double v : domain.points.volume) volume += v;
  const double cell = domain.grid.cell * domain.grid.cell * domain.layer_height;
  const double in_a_cell = volume > 0 ? static_cast<double>(domain.points.size()) * cell / volume : fewest_points;
  if (in_a_cell >= fewest_points) return;
  advise("points",
         fmt::format("a cell holds {:.2g} material points: a flow that spreads gets gaps. Put "
                     "points_per_cell = [2, 2, 2] into [preprocess.grid]",
                     in_a_cell),
         {{"points_in_a_cell", in_a_cell, "1"}});
}

void advise_on_stiffness(const Plan& plan) {
  const SolveOptions& o = plan.options;
  if (!abilities_of(o.integrator).obey_cfl || !o.material.stiffness_is_free()) return;
  const StiffnessDemand demand = lowest_stiffness(o, plan.bound);
  const double shorter = demand.modulus > 0 ? std::sqrt(o.material.youngs_modulus / demand.modulus) : 0;
  if (!(shorter >= longer_steps) || !(plan.bound.speed > 0)) return;
  advise("stiffness",
         fmt::format("youngs_modulus_Pa = {:.3g} makes steps up to {:.2g} times shorter than the flow needs: "
                     "{:.2g} Pa would do. Put stiffness = \"auto\" into [solve.material]",
                     o.material.youngs_modulus, shorter, demand.modulus),
         {{"youngs_modulus", demand.modulus, "Pa"}, {"steps_longer", shorter, "1"}});
}

/// Between which the bed's friction over normal stress lies, however fast a flow slips that stays below the energy line
/// and however thick it is [-]; both 0 where nothing is said of it.
struct FrictionRange {
  double least = 0, most = 0;
  bool alone = true;  ///< nothing else holds the flow back at its bed: no drag, yield or cohesion

  /// Whether it is further from what is usual than landslides scatter. What holds besides friction makes up for little
  /// friction, and nothing for too much of it.
  bool is_unusual(const ReachBounds& usual) const {
    return least > 0 && (least > usual.high || (alone && most < usual.low));
  }
  std::string words() const {
    const auto number = [](double mu) { return fmt::format("{:.2f} ({:.1f} deg)", mu, std::atan(mu) * to_degrees); };
    return most - least < 1e-9 ? number(least) : number(least) + " to " + number(most);
  }
};

FrictionRange friction_range(const Plan& plan) {
  const Domain& domain = *plan.domain;
  const SolveOptions& o = plan.options;
  const auto is_cohesion = [](const auto& raster) { return raster.first == "cohesion_Pa"; };
  if (!std::all_of(domain.bed.begin(), domain.bed.end(), is_cohesion)) return {};  // the analyst's own knowledge
  const auto friction = make_base_friction<double>(o);
  if (friction.holds()) return {};
  const double g = o.gravity_size();
  FrictionRange range{.least = std::numeric_limits<double>::infinity(),
                      .alone = !friction.has_traction() && domain.bed.empty()};
  // From next to nothing to a depth of half a kilometre, at rest and at speeds that halve: grains are held least by the
  // slowest steady flow, other laws at one end or the other.
  for (int halved = 0; halved <= 10; ++halved) {
    const double speed = halved == 10 ? 0 : std::ldexp(plan.bound.fall, -halved);
    for (const double load : {1e-3, 1e6}) {
      const double mu = friction.coefficient(friction.uniform,
                                             {.speed = speed, .normal_stress = g * load, .duration = 0, .load = load});
      range.least = std::min(range.least, mu);
      range.most = std::max(range.most, mu);
    }
  }
  return range;
}

void advise_on_friction(const Plan& plan) {
  const SolveOptions& o = plan.options;
  const double volume = released_volume(plan);
  const ReachBounds usual = usual_reach(volume);
  if (!(usual.high > 0)) return;
  const FrictionRange range = friction_range(plan);
  if (!range.is_unusual(usual)) return;
  std::string sources;
  for (const ReachRegression& one : reach_regressions())
    if (volume >= one.from_volume)
      sources += fmt::format("{}{:.2f} ({}, {})", sources.empty() ? "" : ", ", one.tangent(volume), one.source, one.of);
  const std::string key = o.base.friction_key();
  advise(
      "friction",
      fmt::format("the bed's friction of {}{} is far from the height over length of fall that is usual for {:.3g} m3: "
                  "{}; beyond half and twice of it there is hardly any. Look at [solve.base] {}again: {:.0f} to {:.0f} "
                  "deg",
                  range.words(), key.empty() ? fmt::format(" (law {})", o.base.law_name()) : "", volume, sources,
                  key.empty() ? "" : key + " ", std::atan(usual.low) * to_degrees, std::atan(usual.high) * to_degrees),
      {{"least_friction", range.least, "1"}, {"most_friction", range.most, "1"}, {"volume", volume, "m3"}});
}

/// What is as fast as the energy line allows takes this long to be braked by its bed on level ground, and has been
/// sped up before.
void advise_on_end(const Plan& plan) {
  const SolveOptions& o = plan.options;
  if (!abilities_of(o.integrator).carry_inertia || !o.loads.empty() || !o.walls.empty()) return;
  const double friction = plan.bound.line.friction, speed = plan.bound.fall;
  const double g = o.gravity_size();
  if (!(friction > 0.02) || !(g > 0)) return;
  const double braking = speed / (g * friction);
  if (o.end_time >= braking) return;
  advise("end-time",
         fmt::format("end_time_s = {:.3g} is likely before rest: the energy line allows {:.3g} m/s, and "
                     "the bed alone takes {:.3g} s to brake that. Put end_time_s = {:.2g} and "
                     "stop_kinetic_fraction = 0.001 into [solve]: the run stops by itself at rest",
                     o.end_time, speed, braking, 3 * braking),
         {{"speed", speed, "m s-1"}, {"braking_time", braking, "s"}});
}

/// What points keep of velocity that the grid cannot see moves nothing, and is kinetic energy all the same.
void advise_on_transfer(const SolveOptions& o) {
  const double time = o.transfer_time.value_or(0);
  if (!abilities_of(o.integrator).carry_inertia || !(o.stop_kinetic_fraction > 0) || time <= o.end_time) return;
  const bool by_preset = o.preset == Preset::reference;
  advise("transfer",
         fmt::format(
             "velocity finer than the grid decays over {:.3g} s, longer than the run ({}): points keep it at rest, "
             "and their kinetic energy may never fall to stop_kinetic_fraction = {:g}. {}",
             time, by_preset ? "preset = \"reference\"" : "transfer_time_s", o.stop_kinetic_fraction,
             by_preset ? "The run then goes on to end_time_s" : "Leave one of the two out"),
         {{"decay_time", time, "s"}});
}

}  // namespace

void advise_on_plan(const Plan& plan) {
  advise_on_points(*plan.domain);
  advise_on_stiffness(plan);
  advise_on_friction(plan);
  advise_on_end(plan);
  advise_on_transfer(plan.options);
}

}  // namespace talus::solver
