#include "solver/options/solve.hpp"

#include "solver/options/names.hpp"

namespace talus::solver {
namespace {

/// This function declares what holding base nodes on the ground needs.
void need_separation(recipe::Visitor& v, const SolveOptions& o) {
  const bool is_free = o.base.separation == Separation::free;
  const std::string key = "[solve.base] separation = \"" + o.base.separation_name() + "\" with ";
  const Integrator integrator = o.preset == Preset::reference ? Integrator::newmark : o.integrator;
  v.needs(is_free || !abilities_of(integrator).solve_systems,
          {key + "integrator = \"newmark\", \"quasi-static\", \"auto\" or preset = \"reference\"",
           "Newton's iterations free a base node whose reaction would pull",
           "Take integrator = \"explicit\", or separation = \"free\""});
  v.needs(is_free || o.mapping == Mapping::terrain_following,
          {key + "mapping = \"cartesian\"",
           "its nodes and contact points lie up to a layer beside the ground, and would hold what passes by",
           "Take mapping = \"terrain-following\", or separation = \"free\""});
}

/// What of the recipe inertia by columns cannot do; empty: nothing.
std::string beyond_columns(const SolveOptions& o) {
  if (o.mapping != Mapping::terrain_following) return "mapping = \"cartesian\"";
  if (o.stress_update != StressUpdate::last) return "stress_update = \"musl\"";
  if (o.damping > 0) return "damping";
  if (o.base.separation != Separation::free) return "separation = \"" + o.base.separation_name() + "\"";
  if (o.meets_points()) return o.contact_words();
  for (const WallOptions& wall : o.walls)
    if (wall.axis == Axis::z) return "a [[solve.wall]] across z";
  return {};
}

/// This function declares what column-implicit steps need.
void need_columns(recipe::Visitor& v, const SolveOptions& o) {
  const std::string beyond = abilities_of(o.integrator).solve_columns ? beyond_columns(o) : "";
  v.needs(beyond.empty(), {"[solve] integrator = \"column-implicit\" does not go with " + beyond,
                           "nodes of a column are solved for together, with the bed as their one support",
                           "Leave it out, or take integrator = \"explicit\""});
}

}  // namespace

void SolveOptions::describe(recipe::Visitor& v) {
  TimeOptions::describe(v);
  SchemeOptions::describe(v);
  GravityOptions::describe(v);
  OutputOptions::describe(v, *this);
  recipe::table(v, "implicit", implicit, "implicit steps", *this);
  recipe::list(v, "wall", walls, "plane walls, gates");
  need_few(v, walls);
  recipe::list(v, "obstacle", obstacles, "bodies in the way: walls, barriers, buildings");
  need_names(v, "obstacle", "its forces are recorded under its name", obstacles);
  recipe::list(v, "load", loads, "forces on parts of the mass");
  MassOptions::describe(v);
  recipe::table(v, "base", base, "the bed under it");
  v.needs(ground_contact == GroundContact::nodes || !base.asks_column(),
          {"[solve] ground_contact = \"points\" with [solve.base] law = \"" + base.law_name() + "\"",
           "the law's friction follows from whole columns, which contact points know nothing of",
           "Take ground_contact = \"nodes\", or another law"});
  need_separation(v, *this);
  need_columns(v, *this);
}

std::string SolveOptions::contact_words() const {
  return obstacles.empty() ? "[solve] ground_contact = \"points\"" : "[[solve.obstacle]]";
}

SolveOptions with_preset(SolveOptions o) {
  if (o.preset != Preset::reference) return o;
  if (o.integrator != Integrator::quasi_static) o.integrator = Integrator::newmark;
  o.shape = ShapeKind::linear;
  o.transfer = Transfer::flip;
  o.transfer_time = 1e30;
  o.stress_update = StressUpdate::modified;
  o.implicit.newmark_alpha = 0.25;
  o.implicit.newmark_beta = 0.5;
  o.implicit.newton_iterations = 1;
  o.implicit.operator_ = Operator::elements;
  o.implicit.preconditioner = Preconditioner::diagonal;
  return o;
}

}  // namespace talus::solver
