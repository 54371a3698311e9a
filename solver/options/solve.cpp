#include "solver/options/solve.hpp"

#include <string>

namespace talus::solver {

void SolveOptions::describe(recipe::Visitor& v) {
  TimeOptions::describe(v);
  SchemeOptions::describe(v);
  GravityOptions::describe(v);
  OutputOptions::describe(v);
  v.enter("implicit", "implicit steps");
  implicit.describe(v);
  v.leave();
  recipe::list(v, "wall", walls, "plane walls, gates");
  recipe::list(v, "obstacle", obstacles, "bodies in the way: walls, barriers, buildings");
  recipe::list(v, "load", loads, "forces on parts of the mass");
  MassOptions::describe(v);
  v.enter("base", "the bed under it");
  base.describe(v);
  v.leave();
}

void SolveOptions::check_contacts(std::vector<Fault>& faults) const {
  if (ground_contact == GroundContact::points && mapping != Mapping::cartesian) {
    faults.push_back({"[solve] ground_contact = \"points\" does not go with mapping = \"terrain-following\"",
                      "there the nodes lie on the ground, and meet it exactly",
                      "Leave it out, or take mapping = \"cartesian\""});
  }
  if (!meets_points()) return;
  const std::string what = obstacles.empty() ? "[solve] ground_contact = \"points\"" : "[[solve.obstacle]]";
  if (implicit.linear_solver == LinearSolver::cholesky && integrator != Integrator::explicit_) {
    faults.push_back({what + " does not go with [solve.implicit] linear_solver = \"cholesky\"",
                      "contact between nodes is not in the assembled matrix", "Take linear_solver = \"pcg\""});
  }
  if (energy_budget)
    faults.push_back({what + " does not go with energy_budget = true", "what is lost between nodes is not counted",
                      "Leave energy_budget out"});
}

void SolveOptions::check_integrator(std::vector<Fault>& faults) const {
  if (energy_budget && (integrator != Integrator::explicit_ || stress_update == StressUpdate::modified)) {
    faults.push_back({"[solve] energy_budget = true does not go with this integrator or stress_update",
                      "losses are counted in explicit steps with stress_update = \"usl\"",
                      "Leave it out, or take integrator = \"explicit\""});
  }
  if (deterministic && (integrator != Integrator::explicit_ || energy_budget)) {
    faults.push_back({"[solve] deterministic = true does not go with this integrator or with energy_budget",
                      "sums of implicit steps and of the budget are made in any order on a GPU",
                      "Leave it out, or take integrator = \"explicit\" without energy_budget"});
  }
  const bool splits = !any_material([](const MaterialOptions& m) {
    return m.model != MaterialModel::hencky && m.model != MaterialModel::drucker_prager;
  });
  if (implicit.b_bar && integrator != Integrator::explicit_ && !splits) {
    faults.push_back({"[solve.implicit] b_bar = true does not go with this [solve.material] model",
                      "its pressure does not follow from the volume change alone",
                      "Take model = \"hencky\" or \"drucker-prager\""});
  }
  if (implicit.b_bar && (integrator == Integrator::explicit_ || integrator == Integrator::automatic)) {
    faults.push_back({"[solve.implicit] b_bar = true has no effect on explicit steps",
                      "only implicit steps average the volume change",
                      "Leave it out, or take integrator = \"newmark\" or \"quasi-static\""});
  }
  if (implicit.tangent == Tangent::exact && implicit.linear_solver != LinearSolver::bicgstab) {
    faults.push_back({"[solve.implicit] tangent = \"exact\" does not go with this linear_solver",
                      "the exact tangent is not symmetric", "Take linear_solver = \"bicgstab\""});
  }
  if (implicit.tangent == Tangent::exact && implicit.b_bar) {
    faults.push_back({"[solve.implicit] tangent = \"exact\" does not go with b_bar",
                      "the mean volume change is in the symmetric tangent alone", "Take tangent = \"frozen-yield\""});
  }
}

void SolveOptions::check(std::vector<Fault>& faults) const {
  GravityOptions::check(faults);
  for (const LoadOptions& load : loads) load.check(faults);
  check_integrator(faults);
  check_contacts(faults);
  check_obstacles(obstacles, faults);
  check_walls(walls, faults);
  MassOptions::check(faults);
  base.check(faults);
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
