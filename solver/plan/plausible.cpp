// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe asks that hardly any slide does.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/plan/checks.hpp"
#include "solver/plan/plan.hpp"

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
/// The strongest shaking that an accelerogram may have [m/s2]: five times standard gravity, below which records of
/// earthquakes stay.
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
  const auto material_of = [&](std::size_t p) { return materials[static_cast<std::size_t>(s.material[p])]; };
  std::vector<ColumnLoad> columns(scene.map.count());
  for (std::size_t p = 0; p < s.size(); ++p) {
    ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    column.mass += s.volume[p] * material_of(p)->density;
    column.volume += s.volume[p];
  }
  double strain = 0, pressure = 0, thickness = 0, modulus = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    const double here = column.mass * g / area, strain_here = here / confined_modulus(*material_of(p));
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

}  // namespace

void refuse_implausible(const Plan& plan) {
  judge_weight(plan.scene, plan.options);
  judge_waves(plan.options, plan.bound.speed);
  judge_loads(plan.scene, plan.options);
  judge_shaking(plan.scene.shaking.peak_acceleration(), plan.options);
}

}  // namespace talus::solver
