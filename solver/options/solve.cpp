// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/solve.hpp"

#include <string>

#include <fmt/format.h>

namespace talus::solver {
namespace {

/// The first of the materials that a search cannot weaken.
Fault beyond_materials(const SolveOptions& o) {
  Fault found;
  o.any_material([&](const MaterialOptions& m) {
    if (!found.what.empty()) return true;
    if (!m.steps_implicitly())
      found = {"model = \"" + m.name() + "\"", "its strength depends on the rate of shear, and at rest has none",
               "Take model = \"drucker-prager\""};
    else if (!m.pressure_follows_volume())
      found = {"model = \"" + m.name() + "\"",
               "the volume change is averaged over cells, and its pressure does not follow from that alone",
               "Take model = \"hencky\" for what is to stay elastic"};
    else if (m.softens())
      found = {"softening_slip_m", "a strength that falls on the way has one factor for its peak and another one after",
               "Leave it out, and give the strength that the factor is asked of"};
    return false;
  });
  return found;
}

/// Whether something has a strength that can be divided.
bool has_strength(const SolveOptions& o) {
  const bool bed = visit_law(o.base.law, [](auto law) {
    return requires { law.weaken(nullptr, 1.0); };
  });
  return bed || o.any_material([](const MaterialOptions& m) {
    return visit_law(m.model, [](auto law) {
      return requires(typename decltype(law)::Options & options) { options.weaken(1.0); };
    });
  });
}

/// What of the recipe a search cannot do, and why; empty: nothing.
Fault beyond_search(const SolveOptions& o) {
  if (Fault material = beyond_materials(o); !material.what.empty()) return material;
  if (!visit_law(o.base.law, [](auto law) { return law.acts_at_rest; }))
    return {"[solve.base] law = \"" + o.base.law_name() + "\"", "its friction is that of a flow, not of rest",
            "Take law = \"coulomb\" with the friction at rest, \"stick\" or \"none\""};
  if (!has_strength(o))
    return {"no strength in the recipe", "elastic bodies on a bed that holds, or has no friction, have none to divide",
            "Take model = \"drucker-prager\" or law = \"coulomb\""};
  if (!(o.gravity_size() > 0)) return {"gravity_m_s2 = [0, 0, 0]", "nothing pulls at the ground", "Give gravity"};
  if (o.initial_speed() > 0)
    return {"initial_velocity_m_s", "a factor of safety is that of ground at rest", "Leave it out"};
  if (o.shaking.acts())
    return {"[solve.shaking]", "trials are equilibria, and a record that shakes the ground leaves none",
            "Leave one of the two out"};
  if (o.preset == Preset::reference)
    return {"preset = \"reference\"", "its one linear solve a step does not find an equilibrium", "Leave it out"};
  return {};
}

/// The longest stable explicit step over the CFL step (T11), for points that have a cell to themselves.
constexpr double most_explicit_cfl = 0.8;

/// Declares what column-implicit steps need, and what needs them.
void need_columns(recipe::Visitor& v, const SolveOptions& o) {
  const bool by_columns = abilities_of(o.asked_integrator()).solve_columns;
  const double cfl = o.cfl.value_or(0);
  v.needs(by_columns || cfl <= most_explicit_cfl,
          {fmt::format(
               "[solve] cfl = {:g} is too large for {}", cfl,
               o.integrator == Integrator::automatic ? "explicit steps, which \"auto\" may take" : "this integrator"),
           "points that have a cell to themselves would be thrown off",
           "Take 0.8 at most, leave cfl out, or take integrator = \"column-implicit\""});
  v.needs(!by_columns || cfl <= longest_by_columns(o),
          {fmt::format("[solve] cfl = {:g} is too large for a material that holds tension", cfl),
           "corners of a body that keeps its shape would be thrown off", "Take 1 at most"});
  const Hindrance beyond = by_columns ? beyond_columns(o) : Hindrance{};
  v.needs(!beyond, {"[solve] integrator = \"column-implicit\" does not go with " + beyond.key, beyond.reason,
                    "Leave it out, or take integrator = \"explicit\" or \"auto\""});
}

/// This function declares what a preset sets, and is not given otherwise beside it. The defaults of its keys cannot be
/// told from what was left out, and are taken for that.
void need_preset(recipe::Visitor& v, const SolveOptions& o) {
  const bool free = o.preset != Preset::reference;
  const auto sets = [&](const char* key, bool left_out) {
    v.needs(free || left_out, {fmt::format("[solve] {} beside preset = \"reference\"", key), "the preset sets it",
                               "Leave one of them out"});
  };
  sets("integrator", o.integrator != Integrator::column_implicit && o.integrator != Integrator::explicit_);
  sets("shape", o.shape == ShapeKind::quadratic || o.shape == ShapeKind::linear);
  sets("transfer_time_s", !o.transfer_time);
}

}  // namespace

void StabilityOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  v.flag("factor_of_safety", factor_of_safety,
         "find the factor by which strength can be divided before no equilibrium is left, instead of a run in time");
  v.number("tolerance", tolerance, recipe::Range{1e-4, 0.2}, "width of the bracket over its lower end");
  const Fault beyond = factor_of_safety ? beyond_search(all) : Fault{};
  v.needs(beyond.what.empty(),
          {"[solve.stability] factor_of_safety = true does not go with " + beyond.what, beyond.why, beyond.mend});
  const StabilityOptions usual;
  v.needs(factor_of_safety || tolerance == usual.tolerance,
          {"[solve.stability] is given without factor_of_safety = true", "tolerance has no effect",
           "Give factor_of_safety = true, or leave the table out"});
}

void SolveOptions::describe(recipe::Visitor& v) {
  TimeOptions::describe(v);
  SchemeOptions::describe(v);
  GravityOptions::describe(v);
  OutputOptions::describe(v, *this);
  recipe::table(v, "implicit", implicit, "implicit steps", *this);
  recipe::table(v, "stability", stability, "factor of safety by strength reduction", *this);
  recipe::list(v, "wall", walls, "plane walls, gates");
  v.needs(walls.size() <= most_walls, {"[[solve.wall]] is given " + std::to_string(walls.size()) + " times",
                                       "at most " + std::to_string(most_walls) + " walls fit", "Leave some out"});
  recipe::list(v, "obstacle", obstacles, "bodies in the way: walls, barriers, buildings");
  need_names(v, "obstacle", "its forces are recorded under its name", obstacles);
  recipe::list(v, "load", loads, "forces on parts of the mass");
  describe_inflows(v, inflows, *this);
  recipe::table(v, "shaking", shaking, "the ground shakes: an accelerogram as body force", *this);
  MassOptions::describe(v);
  recipe::table(v, "base", base, "the bed under it");
  recipe::table(v, "water", water, "the water between the grains", *this);
  recipe::table(v, "erosion", erosion, "how ground that can be eroded is taken along", *this);
  base.settle(gravity_size() > 0 ? gravity_size() : 1);
  need_columns(v, *this);
  v.needs(!accuracy || !cfl,
          {"[solve] cfl beside accuracy", "it follows from accuracy", "Leave it out, or leave accuracy out"});
  need_preset(v, *this);
}

double SolveOptions::step_over_cfl() const {
  const bool by_columns = abilities_of(flow_integrator()).solve_columns;
  return cfl.value_or(by_columns ? longest_by_columns(*this) : default_cfl);
}

SolveOptions with_preset(SolveOptions o) {
  if (o.preset != Preset::reference) return o;
  o.integrator = o.asked_integrator();
  o.shape = ShapeKind::linear;
  o.transfer = Transfer::flip;
  o.transfer_time = 1e30;
  o.stress_update = StressUpdate::modified;
  o.implicit.newmark = {0.25, 0.5};
  o.implicit.newton_tolerance = o.implicit.newton_tolerance.value_or(1e-6);  // of contacts: there is one linear solve
  o.implicit.newton_iterations = 1;
  return o;
}

}  // namespace talus::solver
