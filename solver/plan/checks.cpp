// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe asks that hardly any slide does, and what it could do better.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "common/map/usual_reach.hpp"
#include "common/stage/findings.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/step_choice.hpp"

namespace talus::solver {
namespace {

/// The largest strain that a mass may have under its own weight [-]: pressure at its bed over the modulus of confined
/// compression. With more its thickness and its density are not those that were released.
constexpr double most_weight_strain = 0.5;
/// The most times that the speed which the energy line allows may be that of waves: what is stopped at five times their
/// speed is under a pressure of 25 moduli.
constexpr double most_mach = 5;
/// The fastest waves that a solid may have [m/s]: in rock they reach 7 km/s, in diamond 18.
constexpr double fastest_solid_wave = 2e4;
/// The largest strain that a load may cause [-]: its force over the section of what it pulls at, over the modulus.
constexpr double most_load_strain = 1;
/// The strongest shaking that an accelerogram may have [m/s2]: five times standard gravity, beyond all records.
constexpr double strongest_shaking = 5 * 9.80665;

/// The materials of a scene by the numbers that its points have for them.
std::vector<const MaterialOptions*> materials_of(const SolveOptions& o) {
  std::vector<const MaterialOptions*> all{&o.material};
  for (const PartOptions& part : o.parts) all.push_back(&part.material);
  return all;
}

double wave_speed(const MaterialOptions& m) { return make_material<double>(m).wave_speed; }

/// The modulus of confined compression [Pa].
double confined_modulus(const MaterialOptions& m) { return m.density * wave_speed(m) * wave_speed(m); }

/// What lies over each cell of the map: its mass [kg] and volume [m3].
struct ColumnLoad {
  double mass = 0, volume = 0;
};

void judge_weight(const Scene& scene, const SolveOptions& o) {
  const auto materials = materials_of(o);
  const double g = o.gravity_size();
  const double area = scene.grid.spacing * scene.grid.spacing;
  const ParticleState& s = scene.points;
  const auto material_of = [&](std::size_t p) { return materials[s.material_of(p)]; };
  std::vector<double> moduli;
  for (const MaterialOptions* m : materials) moduli.push_back(confined_modulus(*m));
  std::vector<ColumnLoad> columns(scene.map.count());
  for (std::size_t p = 0; p < s.size(); ++p) {
    ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    column.mass += s.volume[p] * material_of(p)->density;
    column.volume += s.volume[p];
  }
  double strain = 0, pressure = 0, thickness = 0, modulus = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    const double here = column.mass * g / area, strain_here = here / moduli[s.material_of(p)];
    if (!(strain_here > strain)) continue;
    strain = strain_here;
    pressure = here;
    thickness = column.volume / area;
    modulus = material_of(p)->youngs_modulus;
  }
  if (strain <= most_weight_strain) return;
  refuse_unless_accepted(
      "weight-strain",
      {fmt::format("the mass strains by {:.3g} under its own weight: {:.3g} m of it press with {:.3g} Pa, where "
                   "youngs_modulus_Pa = {:.3g} resists",
                   strain, thickness, pressure, modulus),
       fmt::format("beyond {:g} its thickness and density are not those that were released", most_weight_strain),
       fmt::format("Give a larger youngs_modulus_Pa; {:.2g} strains by 0.02, and stiffness = \"auto\" finds one that "
                   "suits, from that of the rock on",
                   modulus * strain / 0.02)},
      {{"strain", strain, "1"},
       {"pressure", pressure, "Pa"},
       {"thickness", thickness, "m"},
       {"youngs_modulus", modulus, "Pa"}});
}

/// `speed`: that the energy line allows somewhere in the domain [m/s].
void judge_waves(const SolveOptions& o, double speed) {
  const double fastest = fastest_wave(o);
  double slowest = fastest;
  for (const MaterialOptions* m : materials_of(o)) slowest = std::min(slowest, wave_speed(*m));
  const double mach = slowest > 0 ? speed / slowest : 0;
  if (mach > most_mach)
    refuse_unless_accepted(
        "slow-waves",
        {fmt::format("waves run at {:.3g} m/s, and the energy line allows the mass {:.3g} m/s", slowest, speed),
         fmt::format("what is stopped at {:.3g} times the speed of waves is squashed: the pressure is {:.3g} moduli",
                     mach, mach * mach),
         fmt::format("Give a larger [solve.material] youngs_modulus_Pa: {:.2g} has waves as fast as that",
                     o.material.youngs_modulus * mach * mach)},
        {{"wave_speed", slowest, "m s-1"}, {"speed", speed, "m s-1"}});
  // Not a number, and infinite, where the modulus is beyond all bounds.
  if (!(fastest <= fastest_solid_wave))
    refuse_unless_accepted(
        "fast-waves",
        {fmt::format("waves run at {:.3g} m/s: youngs_modulus_Pa = {:.3g}, density_kg_m3 = {:g}", fastest,
                     o.material.youngs_modulus, o.material.density),
         "in rock they reach 7 km/s, in no solid 20 km/s, and steps have to be as short as they are fast",
         "Give a smaller [solve.material] youngs_modulus_Pa (or that of a [[solve.part]]); stiffness = \"auto\" finds "
         "the lowest that leaves the flow unchanged"},
        {{"wave_speed", fastest, "m s-1"}});
}

void judge_loads(const Scene& scene, const SolveOptions& o) {
  const double modulus = confined_modulus(o.material);
  double strain = 0, force = 0, volume = 0;
  for (std::size_t l = 0; l < o.loads.size() && l < scene.load_volumes.size(); ++l) {
    const auto& f = o.loads[l].force;
    const double size = std::hypot(f[0], f[1], f[2]), of = scene.load_volumes[l];
    const double strain_here = size / std::pow(of, 2.0 / 3) / modulus;
    if (!(strain_here > strain)) continue;
    strain = strain_here;
    force = size;
    volume = of;
  }
  if (strain <= most_load_strain) return;
  refuse_unless_accepted(
      "strong-loads",
      {fmt::format("[[solve.load]] force_N of {:.3g} N on {:.3g} m3 would strain it by {:.3g}", force, volume, strain),
       "the force over the section of what it pulls at is beyond the modulus: it throws the mass out of the domain, "
       "or squashes it",
       fmt::format("Give a smaller force_N, of {:.2g} N or less, or a larger extent_m",
                   force * most_load_strain / strain)},
      {{"force", force, "N"}, {"strain", strain, "1"}, {"volume", volume, "m3"}});
}

void judge_shaking(double peak, const SolveOptions& o) {
  if (!(peak > strongest_shaking)) return;
  refuse_unless_accepted(
      "strong-shaking",
      {fmt::format("[solve.shaking] file shakes the ground with up to {:.3g} m/s2 (scale = {:g})", peak,
                   o.shaking.scale),
       fmt::format("records of earthquakes stay below {:.3g} m/s2", strongest_shaking),
       fmt::format("Check unit, which is \"g\", \"cm/s2\" or \"m/s2\", or give a scale of {:.2g} or less",
                   std::abs(o.shaking.scale) * strongest_shaking / peak)},
      {{"acceleration", peak, "m s-2"}});
}

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
  if (!std::ranges::all_of(domain.bed, is_cohesion)) return {};  // the analyst's own knowledge
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

/// What is as fast as the energy line allows takes so long to be braked on level ground, and has been sped up before.
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

void refuse_implausible(const Plan& plan) {
  judge_weight(plan.scene, plan.options);
  judge_waves(plan.options, plan.bound.speed);
  judge_loads(plan.scene, plan.options);
  judge_shaking(plan.scene.shaking.peak_acceleration(), plan.options);
}

void advise_on_plan(const Plan& plan) {
  advise_on_points(*plan.domain);
  advise_on_stiffness(plan);
  advise_on_friction(plan);
  advise_on_end(plan);
  advise_on_transfer(plan.options);
}

}  // namespace talus::solver
