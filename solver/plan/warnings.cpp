// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe asks that its numbers do not bear out.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/stage/findings.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/step_choice.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
/// What the mass should hold over what its bed asks, as tangents: with less, part of the shear stays in the mass (Frank
/// Slide on beds of 10 to 20 degrees, docs/notes/material-laws.md).
constexpr double recommended_ratio = 1.4;

/// The thickness at which strengths are compared [m]: the largest that is released.
double thickness(const Domain& domain) {
  double most = 0;
  for (double t : domain.release_thickness.values) most = std::isfinite(t) ? std::max(most, t) : most;
  return most;
}

/// What a bed asks of the mass at most, over the normal stress [-]: its largest coefficient of friction, which is that
/// at rest, under any layer (laws that look at the depth hold thin ones best). Where yield and cohesion join the
/// friction of the base nodes, so that they must pass through the mass too, theirs under a layer of `depth` [m]
/// besides; 0: they act on whole columns.
double most_asked(const BaseFriction<double>& friction, double density, double depth) {
  const auto resting = [&](double thick) {
    const double load = density * thick;
    return Slip<double>{.speed = 0, .normal_stress = 9.81 * load, .duration = 0, .load = load};
  };
  double most = 0;
  for (double thick : {1e-6, 1e6}) most = std::max(most, friction.coefficient(friction.uniform, resting(thick)));
  if (!(depth > 0)) return most;
  const Slip<double> slip = resting(depth);
  return std::max(
      most, friction.coefficient(friction.uniform, slip) + friction.yield(friction.uniform, slip) / slip.normal_stress);
}

/// What the bed asks at most, anywhere [-]; 0 where none rubs or the mass sticks.
double bed_friction(const Domain& domain, const SolveOptions& o) {
  const auto friction = make_base_friction<double>(o);
  if (friction.holds()) return 0;
  const double depth = abilities_of(o.integrator).obey_cfl ? 0 : thickness(domain), density = o.material.density;
  if (domain.bed.empty()) return most_asked(friction, density, depth);
  double most = 0;
  each_bed(domain, o, [&](const auto& here) { most = std::max(most, most_asked(here, density, depth)); });
  return most;
}

/// Warns of a cone under which grains would carry tension.
void warn_of_steep_cone(const AskedCone& asked, const std::string& table) {
  if (!(asked.slope > steepest_cone)) return;
  warn("steep-cone",
       fmt::format("{} {} = {:g} asks for the cone sqrt(J2) = {:.3f} p, under which grains would carry tension. It is "
                   "held to {:.3f} p, {:.1f} deg in simple shear",
                   table, asked.key, asked.angle, asked.slope, steepest_cone, std::atan(steepest_cone) * degrees),
       {{"slope", asked.slope, "1"}});
}

/// Warns of a mass that holds less than its bed asks: `held` and `bed` in shares of the pressure.
void warn_of_weak_mass(double held, const AskedCone& cone, const std::string& table, double bed) {
  if (!(held < bed)) return;
  warn("weaker-than-bed",
       fmt::format("the mass gives way inside before it slides on its bed: in simple shear it holds {:.3f} of the "
                   "pressure ({} {} = {:g}), the bed asks up to {:.3f} ({:.1f} deg). Where it does, it moves as on a "
                   "bed of {:.1f} deg. Give a friction angle of {:.1f} deg or more (in simple shear; {:g} times the "
                   "bed's tangent), or lower the bed's",
                   held, table, cone.key, cone.angle, bed, std::atan(bed) * degrees, std::atan(held) * degrees,
                   std::atan(recommended_ratio * bed) * degrees, recommended_ratio),
       {{"held", held, "1"}, {"asked", bed, "1"}});
}

/// Warns of what the numbers of a material do not bear out; `table` is its table of the recipe.
void warn_of_material(const MaterialOptions& material, const std::string& table, double bed, double depth) {
  material.with_law([&](auto, const auto& law) {
    if constexpr (requires { law.density_fault(material.density); })
      if (const std::string fault = law.density_fault(material.density); !fault.empty())
        warn("grain-density", fmt::format("{} density_kg_m3 = {:g} {}", table, material.density, fault),
             {{"density", material.density, "kg m-3"}});
    if constexpr (requires { law.cones(); }) {
      const std::vector<AskedCone> cones = law.cones();
      warn_of_steep_cone(cones.back(), table);
      warn_of_weak_mass(law.held_share(material.density * 9.81 * depth), cones.front(), table, bed);
    }
  });
}

/// Of matter that column-implicit steps let forget its stress (T6d).
void warn_of_lone_columns(const Domain& domain, const SolveOptions& o) {
  const double cfl = o.step_over_cfl();
  if (!abilities_of(o.flow_integrator()).solve_columns || cfl <= longest_unforgotten) return;
  const double share = released_alone(domain, o);
  if (share < noticed_alone) return;
  warn("lone-columns",
       fmt::format("{:.2g} % of the release are columns one cell wide with nothing beside them. With cfl = {:g}, above "
                   "{:g}, column-implicit steps let such columns forget part of their stress, and they do not stand "
                   "without walls. Take cells of half the width, or [solve] cfl = {:g}",
                   100 * share, cfl, longest_unforgotten, longest_unforgotten),
       {{"share", share, "1"}});
}

/// The final velocity of the ground, over its largest, from which an accelerogram is said not to end at rest [-]. What
/// is left of drift in corrected records is far smaller.
constexpr double most_final_velocity = 0.05;

}  // namespace

void warn_of_inflows(const Scene& scene, const SolveOptions& options) {
  for (const InflowSummary& i : scene.inflow.summaries) {
    if (i.late_volume > 0)
      warn("inflow-cut-off",
           fmt::format("[[solve.inflow]] name = \"{}\": the run ends at {:g} s, before {:.4g} m3 of its "
                       "hydrograph have entered. Give a larger end_time_s, unless it is meant so",
                       i.name, options.end_time, i.late_volume),
           {{"late_volume", i.late_volume, "m3"}});
    if (i.depth < 0.5 * scene.grid.layer_height)
      warn("thin-inflow",
           fmt::format("[[solve.inflow]] name = \"{}\": it enters {:.3g} m deep at most, less than half a "
                       "layer of {:g} m. Give a smaller layer_height_m in [preprocess.grid], or let it in "
                       "slower or through a shorter line",
                       i.name, i.depth, scene.grid.layer_height),
           {{"depth", i.depth, "m"}});
  }
}

void warn_of_shaking(const Shaking& shaking, const SolveOptions& o) {
  if (!shaking.acts()) return;
  if (o.end_time < shaking.end())
    warn("shaking-cut-off",
         fmt::format(
             "[solve.shaking] the run ends at {:g} s and the accelerogram at {:g} s: its last {:g} s do not act. "
             "Give end_time_s = {:g} or more",
             o.end_time, shaking.end(), shaking.end() - o.end_time, shaking.end()),
         {{"end_of_shaking", shaking.end(), "s"}});
  const double last = length(shaking.samples.back().velocity), most = shaking.peak_velocity();
  if (last > most_final_velocity * most)
    warn("ground-moves-on",
         fmt::format(
             "[solve.shaking] at the end of the accelerogram the ground still moves at {:.3g} m/s, {:.0f} % of its "
             "largest velocity, and goes on so: the mass has got that much more than from ground that comes to "
             "rest. Correct the record's baseline, unless it is meant so",
             last, 100 * last / most),
         {{"final_velocity", last, "m s-1"}, {"largest_velocity", most, "m s-1"}});
}

/// Warns of a mass on ground below the level of the sea, which the recipe takes for dry land.
void warn_of_sea(const Domain& domain, const SolveOptions& o) {
  if (domain.grid.crs_wkt.empty() || o.water.level) return;
  double lowest = 0;
  for (const double z : domain.terrain.values) lowest = std::isfinite(z) ? std::min(lowest, z) : lowest;
  if (lowest < -1)
    warn("below-sea-level",
         fmt::format("The ground lies down to {:.4g} m below an elevation of 0. Where that is under water, the mass "
                     "weighs less and is dragged: give [solve.water] level_m = 0, or leave it where the land is dry",
                     -lowest),
         {{"lowest", lowest, "m"}});
}

/// Warns of numbers that belong to other laws than the one that a table chooses.
void warn_of_idle_keys(const std::vector<std::string>& idle, const std::string& table, const std::string& law) {
  if (idle.empty()) return;
  warn("idle-keys", fmt::format("{} {} {} no effect with {}: other laws use {}. Leave {} out", table,
                                fmt::join(idle, ", "), idle.size() == 1 ? "has" : "have", law,
                                idle.size() == 1 ? "it" : "them", idle.size() == 1 ? "it" : "them"));
}

void warn_of_plan(const Plan& plan) {
  const Domain& domain = *plan.domain;
  const SolveOptions& options = plan.options;
  warn_of_idle_keys(options.base.idle(), "[solve.base]", fmt::format("law = \"{}\"", options.base.law_name()));
  const auto warn_of_idle_keys_of = [](const MaterialOptions& material, const std::string& table) {
    warn_of_idle_keys(material.idle(), table, fmt::format("model = \"{}\"", material.name()));
  };
  warn_of_idle_keys_of(options.material, "[solve.material]");
  const double bed = bed_friction(domain, options), depth = thickness(domain);
  warn_of_material(options.material, "[solve.material]", bed, depth);
  for (const PartOptions& part : options.parts) {
    const std::string table = fmt::format("[[solve.part]] \"{}\"", part.release);
    warn_of_material(part.material, table, bed, depth);
    warn_of_idle_keys_of(part.material, table);
  }
  warn_of_lone_columns(domain, options);
  warn_of_sea(domain, options);
  warn_of_inflows(plan.scene, options);
  warn_of_shaking(plan.scene.shaking, options);
  warn_of_unkept_accuracy(domain, plan.asked, plan.bound.line);
}

}  // namespace talus::solver
