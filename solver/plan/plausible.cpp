// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/plausible.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/plan/plan.hpp"

namespace talus::solver {
namespace {

/// The materials of a scene by the numbers that its points have for them.
std::vector<const MaterialOptions*> materials_of(const SolveOptions& o) {
  std::vector<const MaterialOptions*> all{&o.material};
  for (const PartOptions& part : o.parts) all.push_back(&part.material);
  return all;
}

/// The modulus of confined compression [Pa].
double confined_modulus(const MaterialOptions& m) {
  const double wave = make_material<double>(m).wave_speed;
  return m.density * wave * wave;
}

/// What lies over each cell of the map: its mass [kg] and volume [m3].
struct ColumnLoad {
  double mass = 0, volume = 0;
};

void weigh(const Scene& scene, const SolveOptions& o, ScenePlausibility& found) {
  const auto materials = materials_of(o);
  const double g = std::hypot(o.gravity[0], o.gravity[1], o.gravity[2]);
  const double area = scene.grid.spacing * scene.grid.spacing;
  const ParticleState& s = scene.points;
  const auto material_of = [&](std::size_t p) { return static_cast<std::size_t>(s.material[p]); };
  std::vector<ColumnLoad> columns(scene.map.count());
  for (std::size_t p = 0; p < s.size(); ++p) {
    ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    column.mass += s.volume[p] * materials[material_of(p)]->density;
    column.volume += s.volume[p];
  }
  for (std::size_t p = 0; p < s.size(); ++p) {
    const ColumnLoad& column = columns[scene.map.index(s.cell[0][p], s.cell[1][p])];
    const MaterialOptions& m = *materials[material_of(p)];
    const double pressure = column.mass * g / area, strain = pressure / confined_modulus(m);
    if (!(strain > found.weight_strain)) continue;
    found.weight_strain = strain;
    found.weight = pressure;
    found.thickness = column.volume / area;
    found.weighed_modulus = m.youngs_modulus;
  }
}

void pull(const Scene& scene, const SolveOptions& o, ScenePlausibility& found) {
  const double modulus = confined_modulus(o.material);
  for (std::size_t l = 0; l < o.loads.size() && l < scene.load_volumes.size(); ++l) {
    const auto& f = o.loads[l].force;
    const double force = std::hypot(f[0], f[1], f[2]), volume = scene.load_volumes[l];
    const double strain = force / std::pow(volume, 2.0 / 3) / modulus;
    if (!(strain > found.load_strain)) continue;
    found.load_strain = strain;
    found.load = force;
    found.load_volume = volume;
  }
}

void judge_weight(const ScenePlausibility& n, Acceptance& acceptance) {
  if (n.weight_strain <= most_weight_strain) return;
  acceptance.judge(
      {"weight-strain",
       {fmt::format("the mass strains by {:.3g} under its own weight: {:.3g} m of it press with {:.3g} Pa, where "
                    "youngs_modulus_Pa = {:.3g} resists",
                    n.weight_strain, n.thickness, n.weight, n.weighed_modulus),
        fmt::format("beyond {:g} its thickness and density are not those that were released", most_weight_strain),
        fmt::format("Give a larger youngs_modulus_Pa; {:.2g} strains by 0.02, and stiffness = \"auto\" finds one that "
                    "suits, from that of the rock on",
                    n.weighed_modulus * n.weight_strain / 0.02)}});
}

void judge_waves(const ScenePlausibility& n, const SolveOptions& o, Acceptance& acceptance) {
  if (n.mach() > most_mach)
    acceptance.judge(
        {"slow-waves",
         {fmt::format("waves run at {:.3g} m/s, and the energy line allows the mass {:.3g} m/s", n.wave_speed, n.speed),
          fmt::format("what is stopped at {:.3g} times the speed of waves is squashed: the pressure is {:.3g} moduli",
                      n.mach(), n.mach() * n.mach()),
          fmt::format("Give a larger [solve.material] youngs_modulus_Pa: {:.2g} has waves as fast as that",
                      o.material.youngs_modulus * n.mach() * n.mach())}});
  // Not a number, and infinite, where the modulus is beyond all bounds.
  if (!(n.fastest_wave <= fastest_solid_wave))
    acceptance.judge(
        {"fast-waves",
         {fmt::format("waves run at {:.3g} m/s: youngs_modulus_Pa = {:.3g}, density_kg_m3 = {:g}", n.fastest_wave,
                      o.material.youngs_modulus, o.material.density),
          "in rock they reach 7 km/s, in no solid 20 km/s, and steps have to be as short as they are fast",
          "Give a smaller [solve.material] youngs_modulus_Pa (or that of a [[solve.part]]); stiffness = \"auto\" finds "
          "the lowest that leaves the flow unchanged"}});
}

void judge_loads(const ScenePlausibility& n, Acceptance& acceptance) {
  if (n.load_strain <= most_load_strain) return;
  acceptance.judge(
      {"strong-loads",
       {fmt::format("[[solve.load]] force_N of {:.3g} N on {:.3g} m3 would strain it by {:.3g}", n.load, n.load_volume,
                    n.load_strain),
        "the force over the section of what it pulls at is beyond the modulus: it throws the mass out of the domain, "
        "or squashes it",
        fmt::format("Give a smaller force_N, of {:.2g} N or less, or a larger box_m",
                    n.load * most_load_strain / n.load_strain)}});
}

void judge_shaking(const ScenePlausibility& n, const SolveOptions& o, Acceptance& acceptance) {
  if (!(n.shaking > strongest_shaking)) return;
  acceptance.judge({"strong-shaking",
                    {fmt::format("[solve.shaking] file shakes the ground with up to {:.3g} m/s2 (scale = {:g})",
                                 n.shaking, o.shaking.scale),
                     fmt::format("records of earthquakes stay below {:.3g} m/s2", strongest_shaking),
                     fmt::format("Check unit, which is \"g\", \"cm/s2\" or \"m/s2\", or give a scale of {:.2g} or less",
                                 std::abs(o.shaking.scale) * strongest_shaking / n.shaking)}});
}

}  // namespace

ScenePlausibility plausibility_of(const Plan& plan) {
  const Scene& scene = plan.scene;
  const SolveOptions& options = plan.options;
  ScenePlausibility found;
  weigh(scene, options, found);
  pull(scene, options, found);
  found.fastest_wave = fastest_wave(options);
  found.wave_speed = found.fastest_wave;
  for (const MaterialOptions* m : materials_of(options))
    found.wave_speed = std::min(found.wave_speed, make_material<double>(*m).wave_speed);
  found.speed = plan.bound.speed;
  found.shaking = scene.shaking.peak_acceleration();
  return found;
}

void judge_scene(const ScenePlausibility& numbers, const SolveOptions& options, Acceptance& acceptance) {
  judge_weight(numbers, acceptance);
  judge_waves(numbers, options, acceptance);
  judge_loads(numbers, acceptance);
  judge_shaking(numbers, options, acceptance);
}

std::vector<std::string> accepted_before_run(const SolveOptions& options) {
  std::vector<std::string> names = options.accept;
  std::erase(names, torn_body);
  return names;
}

Acceptance judge_plan(const Plan& plan) {
  Acceptance acceptance("solve", accepted_before_run(plan.options));
  acceptance.collect();
  judge_scene(plausibility_of(plan), plan.options, acceptance);
  acceptance.settle();
  return acceptance;
}

void warn_of_unmet(const std::vector<std::string>& accept, const Facts& met) {
  Acceptance("solve", accept).warn_of_unmet(met);
}

}  // namespace talus::solver
