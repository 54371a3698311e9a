// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/solve.hpp"

#include <fmt/format.h>

#include "solver/options/hindrances.hpp"
#include "solver/options/names.hpp"

namespace talus::solver {
namespace {

/// The longest stable explicit step over the CFL step (T11), for points that have a cell to themselves.
constexpr double most_explicit_cfl = 0.8;

/// This function declares what holding base nodes on the ground needs.
void need_separation(recipe::Visitor& v, const SolveOptions& o) {
  const bool is_free = o.base.separation == Separation::free;
  const std::string key = "[solve.base] separation = \"" + o.base.separation_name() + "\" with ";
  v.needs(is_free || abilities_of(o.asked_integrator()).obey_cfl,
          {key + "integrator = \"newmark\", \"quasi-static\" or preset = \"reference\"",
           "Newton's iterations free a base node whose reaction would pull",
           "Take integrator = \"explicit\", or separation = \"free\""});
  v.needs(
      is_free || o.mapping == Mapping::terrain_following,
      {key + "mapping = \"cartesian\"", "its nodes lie up to a layer beside the ground, and would hold what passes by",
       "Take mapping = \"terrain-following\", or separation = \"free\""});
}

/// This function declares what column-implicit steps need, and what needs them.
void need_columns(recipe::Visitor& v, const SolveOptions& o) {
  const bool by_columns = abilities_of(o.asked_integrator()).solve_columns;
  v.needs(by_columns || o.cfl <= most_explicit_cfl,
          {fmt::format("[solve] cfl = {:g} is too large for this integrator", o.cfl),
           "points that have a cell to themselves would be thrown off", "Take 0.8 at most"});
  v.needs(!by_columns || o.cfl <= longest_by_columns(o),
          {fmt::format("[solve] cfl = {:g} is too large for a material that holds tension", o.cfl),
           "corners of a body that keeps its shape would be thrown off", "Take 1 at most"});
  const Hindrance beyond = by_columns ? beyond_columns(o) : Hindrance{};
  v.needs(!beyond, {"[solve] integrator = \"column-implicit\" does not go with " + beyond.key, beyond.reason,
                    "Leave it out, or take integrator = \"explicit\" or \"auto\""});
}

/// This function declares what `accuracy` settles, and is not given beside it.
void need_accuracy(recipe::Visitor& v, const SolveOptions& o) {
  const std::string why = "it follows from accuracy", mend = "Leave it out, or leave accuracy out";
  v.needs(!o.accuracy || o.cfl == default_cfl, {"[solve] cfl beside accuracy", why, mend});
}

/// This function declares what a preset sets, and is not given otherwise beside it. The defaults of its keys cannot be
/// told from what was left out, and are taken for that.
void need_preset(recipe::Visitor& v, const SolveOptions& o) {
  const bool free = o.preset != Preset::reference;
  const auto sets = [&](const char* key, bool left_out) {
    v.needs(free || left_out, {fmt::format("[solve] {} beside preset = \"reference\"", key), "the preset sets it",
                               "Leave one of them out"});
  };
  sets("integrator", o.integrator != Integrator::column_implicit && o.integrator != Integrator::automatic);
  sets("shape", o.shape == ShapeKind::quadratic || o.shape == ShapeKind::linear);
  sets("transfer_time_s", !o.transfer_time);
}

}  // namespace

void SolveOptions::describe(recipe::Visitor& v) {
  TimeOptions::describe(v);
  SchemeOptions::describe(v);
  GravityOptions::describe(v);
  OutputOptions::describe(v, *this);
  recipe::table(v, "implicit", implicit, "implicit steps", *this);
  recipe::table(v, "stability", stability, "factor of safety by strength reduction", *this);
  recipe::list(v, "wall", walls, "plane walls, gates");
  need_few(v, walls);
  recipe::list(v, "obstacle", obstacles, "bodies in the way: walls, barriers, buildings");
  need_names(v, "obstacle", "its forces are recorded under its name", obstacles);
  recipe::list(v, "load", loads, "forces on parts of the mass");
  describe_inflows(v, inflows, *this);
  recipe::table(v, "shaking", shaking, "the ground shakes: an accelerogram as body force", *this);
  MassOptions::describe(v);
  recipe::table(v, "base", base, "the bed under it");
  need_separation(v, *this);
  need_columns(v, *this);
  need_accuracy(v, *this);
  need_preset(v, *this);
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
