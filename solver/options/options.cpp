#include "solver/options/options.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace talus::solver {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

struct ConeFit {
  double slope, cohesion;  // sqrt(J2) = slope p + cohesion
};

/// Cone through Mohr-Coulomb of this friction angle and cohesion; in plane strain for flow with this dilatancy angle.
ConeFit fit_cone(Cone cone, double angle, double cohesion, double dilatancy) {
  const double s = std::sin(angle), c = std::cos(angle), t = std::tan(dilatancy);
  switch (cone) {
    case Cone::compression: return {6 * s / (std::sqrt(3.0) * (3 - s)), 6 * cohesion * c / (std::sqrt(3.0) * (3 - s))};
    case Cone::extension: return {6 * s / (std::sqrt(3.0) * (3 + s)), 6 * cohesion * c / (std::sqrt(3.0) * (3 + s))};
    default: {
      // No plastic strain across the plane: s_z = -(2/3) beta sqrt(J2), so that the circle in the plane has the radius
      // sqrt(J2 (1 - beta^2 / 3)) about the pressure p - (beta / 3) sqrt(J2).
      const double beta = 3 * t / std::sqrt(9 + 12 * t * t);
      const double share = std::sqrt(1 - beta * beta / 3) + beta / 3 * s;
      return {s / share, cohesion * c / share};
    }
  }
}

}  // namespace

void MaterialOptions::describe(recipe::Visitor& v) {
  using recipe::Range;
  recipe::choice(v, "model", model,
                 {{"drucker-prager", MaterialModel::drucker_prager},
                  {"hencky", MaterialModel::hencky},
                  {"corotated", MaterialModel::corotated},
                  {"linear-elastic", MaterialModel::linear_elastic}},
                 "constitutive law");
  v.number("density_kg_m3", density, recipe::positive, "bulk density of the released mass");
  v.number("youngs_modulus_Pa", youngs_modulus, recipe::positive,
           "stiffness; sets the step size, see docs/user-guide.md");
  recipe::choice(v, "stiffness", stiffness, {{"as-given", StiffnessKind::as_given}, {"auto", StiffnessKind::automatic}},
                 "auto: the lowest modulus up to that one which leaves the flow unchanged");
  v.flag("stiffness_check", stiffness_check, "run again with twice the modulus and say how far the deposit moves");
  v.number("poisson_ratio", poisson_ratio, Range{-1, 0.5, true, true}, "Poisson's ratio");
  v.number("friction_angle_deg", friction_angle, Range{0, 90, false, true}, "internal friction angle");
  v.number("cohesion_Pa", cohesion, recipe::not_negative, "cohesion");
  v.number("dilatancy_angle_deg", dilatancy_angle, Range{0, 90, false, true}, "dilatancy angle");
  v.number("tension_cutoff_Pa", tension_cutoff, recipe::not_negative, "largest mean tension carried");
  v.number("pore_pressure_ratio", pore_pressure_ratio, Range{0, 1},
           "share of the pressure that water carries (saturated ground); friction acts on the rest");
  v.number("softening_slip_m", softening_slip, recipe::not_negative,
           "slip over which friction and cohesion fall to the residual ones; 0: they do not");
  v.number("residual_friction_angle_deg", residual_friction_angle, Range{0, 90, false, true},
           "after softening: internal friction angle");
  v.number("residual_cohesion_Pa", residual_cohesion, recipe::not_negative, "after softening: cohesion");
  recipe::choice(
      v, "cone", cone,
      {{"compression", Cone::compression}, {"extension", Cone::extension}, {"plane-strain", Cone::plane_strain}},
      "how the cone meets Mohr-Coulomb");
}

void PartOptions::describe(recipe::Visitor& v) {
  v.text("release", release,
         "name of the release (of talus-preprocess) that is of this material; the keys below have their own defaults");
  material.describe(v);
}

bool SolveOptions::any_material(const std::function<bool(const MaterialOptions&)>& is) const {
  return is(material) ||
         std::any_of(parts.begin(), parts.end(), [&](const PartOptions& part) { return is(part.material); });
}

void BaseOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "law", law,
                 {{"coulomb", FrictionLaw::coulomb},
                  {"velocity-weakening", FrictionLaw::velocity_weakening},
                  {"voellmy", FrictionLaw::voellmy},
                  {"none", FrictionLaw::none},
                  {"stick", FrictionLaw::stick}},
                 "friction between the mass and its bed");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true},
           "coulomb, voellmy: friction angle of the bed");
  v.number("peak_coefficient", peak_coefficient, recipe::not_negative, "velocity-weakening: coefficient at rest");
  v.number("steady_coefficient", steady_coefficient, recipe::not_negative,
           "velocity-weakening: coefficient at high speed");
  v.number("characteristic_speed_m_s", characteristic_speed, recipe::positive,
           "velocity-weakening: speed of half the drop");
  v.number("turbulence_m_s2", turbulence, recipe::positive,
           "voellmy: xi; a traction of rho g v^2 / xi besides friction");
  v.number("cohesion_Pa", cohesion, recipe::not_negative,
           "traction besides friction, wherever the mass touches its bed");
  v.number("pore_pressure_ratio", pore_pressure_ratio, recipe::Range{0, 1},
           "share of the normal stress on the bed that water carries (saturated ground); friction acts on the rest");
}

double* BaseOptions::named(const std::string& key) {
  if (key == "friction_angle_deg") return &friction_angle;
  if (key == "peak_coefficient") return &peak_coefficient;
  if (key == "steady_coefficient") return &steady_coefficient;
  if (key == "characteristic_speed_m_s") return &characteristic_speed;
  if (key == "turbulence_m_s2") return &turbulence;
  if (key == "cohesion_Pa") return &cohesion;
  if (key == "pore_pressure_ratio") return &pore_pressure_ratio;
  return nullptr;
}

bool BaseOptions::uses(const std::string& key) const {
  const bool weakens = law == FrictionLaw::velocity_weakening, flows = law == FrictionLaw::voellmy;
  if (law == FrictionLaw::none || law == FrictionLaw::stick) return false;
  if (key == "friction_angle_deg") return law == FrictionLaw::coulomb || flows;
  if (key == "turbulence_m_s2") return flows;
  if (key == "peak_coefficient" || key == "steady_coefficient" || key == "characteristic_speed_m_s") return weakens;
  return key == "cohesion_Pa" || key == "pore_pressure_ratio";
}

void ImplicitOptions::describe(recipe::Visitor& v) {
  v.number("step_s", step, recipe::positive, "step size; cut where a step does not converge, grown again after");
  v.number("newmark_alpha", alpha, recipe::Range{0, 1, true, false}, "newmark: alpha (0.25: trapezoid)");
  v.number("newmark_beta", beta, recipe::fraction, "newmark: beta (0.5: trapezoid; more damps)");
  v.integer("newton_iterations", newton_iterations, recipe::Range{1, 1000},
            "most Newton iterations a step; 1: one linear solve");
  v.number("newton_tolerance", newton_tolerance, recipe::Range{0, 1, true, true},
           "unbalanced force over the forces' size");
  recipe::choice(
      v, "tangent", tangent, {{"frozen-yield", Tangent::frozen_yield}, {"exact", Tangent::exact}},
      "frozen-yield: symmetric, friction at the pressure of the last iteration; exact: not symmetric, needs bicgstab");
  recipe::choice(
      v, "linear_solver", linear_solver,
      {{"pcg", LinearSolver::pcg}, {"bicgstab", LinearSolver::bicgstab}, {"cholesky", LinearSolver::cholesky}},
      "conjugate gradients, or stabilised bi-conjugate ones, never assembled; or sparse Cholesky");
  v.number("linear_tolerance", linear_tolerance, recipe::Range{0, 1, true, true},
           "pcg, bicgstab: residual over right-hand side");
  recipe::choice(v, "forcing", forcing, {{"eisenstat-walker", Forcing::eisenstat_walker}, {"fixed", Forcing::fixed}},
                 "eisenstat-walker: no more exact than Newton's iteration can use, linear_tolerance at the finest; "
                 "fixed: always linear_tolerance");
  v.integer("linear_iterations", linear_iterations, recipe::Range{1, 1e9}, "pcg: most iterations");
  recipe::choice(v, "operator", form,
                 {{"points", Operator::points}, {"elements", Operator::elements}, {"stencil", Operator::stencil}},
                 "pcg: the tangent's product point by point, by stored elements, or by assembled blocks");
  recipe::choice(v, "preconditioner", preconditioner,
                 {{"block", Preconditioner::block},
                  {"column", Preconditioner::column},
                  {"diagonal", Preconditioner::diagonal},
                  {"gauss-seidel", Preconditioner::gauss_seidel},
                  {"multigrid", Preconditioner::multigrid}},
                 "pcg, bicgstab: the diagonal, 3 x 3 blocks, whole columns of nodes, Gauss-Seidel over columns, or "
                 "multigrid with that");
  v.integer("step_cuts", step_cuts, recipe::Range{0, 30}, "halvings of a step before the run gives up");
  v.number("apex", apex, recipe::not_negative,
           "drucker-prager: pressure over which the tip of the cone is rounded, in weights of a cell");
  v.flag("b_bar", b_bar, "volume change as the mean over a cell: nearly incompressible material does not lock");
  v.number(
      "filler", filler, recipe::Range{0, 1, false, true},
      "quasi-static: springs against each step's displacement of nearly empty nodes, stiffness over a full cell's");
}

void WallOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}, "normal of the wall");
  v.number("position_m", position, recipe::any, "map coordinate, or elevation");
  recipe::choice(v, "material_is", side, {{"above", Side::above}, {"below", Side::below}},
                 "where the material lies: at larger (above) or smaller (below) coordinates");
  recipe::choice(v, "kind", kind,
                 {{"roller", WallKind::roller}, {"fixed", WallKind::fixed}, {"frictional", WallKind::frictional}},
                 "roller: no motion along the axis; fixed: none at all; frictional: one-sided, with friction");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "frictional: friction angle");
  v.number("speed_m_s", speed, recipe::any, "velocity of the wall along its axis");
  v.number("from_s", from, recipe::not_negative, "the wall is there from this time");
  v.number("to_s", to, recipe::not_negative, "and goes at this time (a gate)");
}

void LoadOptions::describe(recipe::Visitor& v) {
  v.numbers("box_m", box, recipe::any,
            "west, east, south, north, bottom, top (the last two above the ground): points starting there");
  v.numbers("force_N", force, recipe::any, "force on them in all: east, north, up");
  v.number("ramp_s", ramp, recipe::not_negative, "time over which it grows to its full size");
  v.number("from_s", from, recipe::not_negative, "it pulls from this time");
  v.number("to_s", to, recipe::not_negative, "to this time");
}

void SolveOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "preset", preset, {{"none", Preset::none}, {"reference", Preset::reference}},
                 "reference: the implicit scheme of the reference paper as it stands (docs/theory.md)");
  recipe::choice(
      v, "integrator", integrator,
      {{"explicit", Integrator::explicit_},
       {"newmark", Integrator::newmark},
       {"quasi-static", Integrator::quasi_static},
       {"auto", Integrator::automatic}},
      "time integration; auto: explicit or newmark, whichever takes less time, found by trying as the run goes on");
  v.number("gravity_ramp_s", gravity_ramp, recipe::not_negative, "time over which gravity grows to its full size");
  v.integer("gravity_loading_steps", gravity_loading_steps, recipe::Range{0, 100000},
            "quasi-static steps that bring the mass to equilibrium before the start; 0: start from zero stress");
  v.path("domain", domain, "domain of talus-preprocess; empty: domain.vdb in the output folder");
  v.number("end_time_s", end_time, recipe::positive, "simulated time");
  v.number("stop_kinetic_fraction", stop_kinetic_fraction, recipe::Range{0, 1, false, true},
           "stop once the kinetic energy falls below this part of its peak; 0: run to the end");
  recipe::choice(v, "precision", precision, {{"double", Precision::double_}, {"single", Precision::single_}},
                 "numbers the state is kept in");
  recipe::choice(v, "mapping", mapping,
                 {{"terrain-following", Mapping::terrain_following}, {"cartesian", Mapping::cartesian}},
                 "background grid: layers follow the ground, or lie level");
  recipe::choice(v, "ground_contact", ground, {{"nodes", GroundContact::nodes}, {"points", GroundContact::points}},
                 "Cartesian grid: the ground met by the nodes at or below it, or by points between the nodes");
  recipe::choice(v, "shape", shape,
                 {{"quadratic", ShapeKind::quadratic}, {"gimp", ShapeKind::gimp}, {"linear", ShapeKind::linear}},
                 "functions of the grid: B-splines, hats averaged over the box of each point, or hats");
  recipe::choice(v, "transfer", transfer, {{"apic", Transfer::apic}, {"flip", Transfer::flip}},
                 "how velocity passes between points and grid");
  v.number("transfer_time", transfer_time, recipe::not_negative,
           "CFL steps over which velocity finer than the grid decays; 0: at every step");
  recipe::choice(v, "stress_update", stress_update, {{"usl", StressUpdate::last}, {"musl", StressUpdate::modified}},
                 "stress from the grid's new velocity (usl), or from the points' mapped back (musl)");
  v.number("damping", damping, recipe::Range{0, 1, false, true}, "local non-viscous damping factor (Cundall)");
  v.number("cfl", courant, recipe::Range{0, 0.8, true, false}, "step size over the CFL step");
  v.number("largest_step_s", largest_step, recipe::positive, "upper bound of the step size");
  v.numbers("gravity_m_s2", gravity, recipe::any, "gravity: east, north, up");
  v.numbers("initial_velocity_m_s", initial_velocity, recipe::any,
            "velocity of the whole mass at the start: east, north, up");
  v.number("frame_interval_s", frame_interval, recipe::positive, "time between frames");
  v.number("history_interval_s", history_interval, recipe::positive, "time between records of energy and mass");
  v.number("checkpoint_interval_s", checkpoint_interval, recipe::not_negative,
           "simulated time between checkpoints; 0: only when interrupted");
  v.number("map_threshold_m", map_threshold, recipe::positive,
           "thickness from which speed, pressure and arrival count");
  v.flag("point_frames", point_frames, "write the material points of each frame into run.h5");
  v.flag("vdb_frames", vdb_frames, "write the material points of each frame as frames/*.vdb as well");
  v.flag("energy_budget", energy_budget,
         "explicit steps: keep what is lost to the bed, to plastic flow, to damping and between points and grid, and "
         "the impulse of bed and walls (two to three times as slow on a GPU)");
  v.flag("deterministic", deterministic,
         "explicit steps: the same bits on every run on a GPU too, as on the CPU always (slower)");
  v.enter("implicit", "implicit steps");
  implicit.describe(v);
  v.leave();
  recipe::list(v, "wall", walls, "plane walls, gates");
  recipe::list(v, "obstacle", obstacles, "bodies in the way: walls, barriers, buildings");
  recipe::list(v, "load", loads, "forces on parts of the mass");
  recipe::list(v, "part", parts, "a release of another material than [solve.material]");
  v.enter("material", "the sliding mass");
  material.describe(v);
  v.leave();
  v.enter("base", "the bed under it");
  base.describe(v);
  v.leave();
}

double ObstacleOptions::friction() const { return std::tan(friction_angle * radians_per_degree); }

void ObstacleOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "under which its force is recorded");
  v.path("level_set", level_set,
         "OpenVDB file of signed distances [m], negative inside; empty: obstacles.vdb in the output folder "
         "(talus-preprocess)");
  v.text("grid", grid,
         "name of the level set in that file; empty: the obstacle's own, or the only one of a level_set that is given");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "friction angle of its surface");
}

void SolveOptions::check_contacts(std::vector<Fault>& faults) const {
  if (ground == GroundContact::points && mapping != Mapping::cartesian) {
    faults.push_back({"[solve] ground_contact = \"points\" does not go with mapping = \"terrain-following\"",
                      "there the nodes lie on the ground, and meet it exactly",
                      "Leave it out, or take mapping = \"cartesian\""});
  }
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    const std::string& name = obstacles[o].name;
    const bool plain =
        !name.empty() &&
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
    if (!plain)
      faults.push_back({fmt::format("[[solve.obstacle]] number {}: name = \"{}\"", o + 1, name),
                        "its forces are recorded under its name", "Give it one of letters, digits, - and _"});
    for (std::size_t earlier = 0; earlier < o; ++earlier) {
      if (plain && obstacles[earlier].name == name)
        faults.push_back({fmt::format("[[solve.obstacle]] name = \"{}\" is given twice", name),
                          "its forces are recorded under its name", "Rename one"});
    }
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

void SolveOptions::check(std::vector<Fault>& faults) const {
  const auto three = [&](const char* key, const std::vector<double>& values) {
    if (values.size() == 3) return;
    faults.push_back({fmt::format("[solve] {} has {} numbers", key, values.size()), "it is a vector: east, north, up",
                      fmt::format("Give three: {} = [0.0, 0.0, 0.0]", key)});
  };
  three("gravity_m_s2", gravity);
  three("initial_velocity_m_s", initial_velocity);
  for (const LoadOptions& load : loads) {
    if (load.box.size() == 6 && load.force.size() == 3) continue;
    faults.push_back({"[[solve.load]] box_m or force_N has the wrong number of values", "a box has six, a force three",
                      "Give box_m = [west, east, south, north, bottom, top] and force_N = [east, north, up]"});
  }
  if (energy_budget && (integrator != Integrator::explicit_ || stress_update == StressUpdate::modified)) {
    faults.push_back({"[solve] energy_budget = true does not go with this integrator or stress_update",
                      "losses are counted in explicit steps with stress_update = \"usl\"",
                      "Leave it out, or take integrator = \"explicit\""});
  }
  check_contacts(faults);
  if (deterministic && (integrator != Integrator::explicit_ || energy_budget)) {
    faults.push_back({"[solve] deterministic = true does not go with this integrator or with energy_budget",
                      "sums of implicit steps and of the budget are made in any order on a GPU",
                      "Leave it out, or take integrator = \"explicit\" without energy_budget"});
  }
  if (walls.size() > most_walls) {
    faults.push_back({fmt::format("[[solve.wall]] is given {} times", walls.size()),
                      fmt::format("at most {} walls fit", most_walls), "Leave some out"});
  }
  if (parts.size() >= most_materials) {
    faults.push_back({fmt::format("[[solve.part]] is given {} times", parts.size()),
                      fmt::format("a scene has at most {} materials", most_materials),
                      "Give releases of the same material the same name, or leave some out"});
  }
  for (const PartOptions& part : parts) {
    if (part.material.stiffness == StiffnessKind::as_given && !part.material.stiffness_check) continue;
    faults.push_back({fmt::format("[[solve.part]] release = \"{}\" gives stiffness or stiffness_check", part.release),
                      "they are the whole scene's", "Give them in [solve.material]"});
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
  if (material.stiffness == StiffnessKind::automatic && material.model != MaterialModel::drucker_prager) {
    faults.push_back({"[solve.material] stiffness = \"auto\" does not go with this model",
                      "what an elastic body does depends on its stiffness",
                      "Take model = \"drucker-prager\", or leave stiffness out"});
  }
  const auto check_material = [&](const std::string& table, const MaterialOptions& m) {
    if (m.dilatancy_angle > m.friction_angle) {
      faults.push_back({fmt::format("{} dilatancy_angle_deg = {} is above friction_angle_deg = {}", table,
                                    m.dilatancy_angle, m.friction_angle),
                        "the material would make energy as it shears",
                        "Lower dilatancy_angle_deg; 0 is usual for run-out"});
    }
    if (m.softening_slip > 0 && (m.residual_friction_angle > m.friction_angle || m.residual_cohesion > m.cohesion)) {
      faults.push_back({fmt::format("{} softens to {} deg and {} Pa, from {} deg and {} Pa", table,
                                    m.residual_friction_angle, m.residual_cohesion, m.friction_angle, m.cohesion),
                        "a residual strength is no larger than the first",
                        "Lower residual_friction_angle_deg or residual_cohesion_Pa"});
    }
  };
  check_material("[solve.material]", material);
  for (const PartOptions& part : parts)
    check_material("[[solve.part]] release = \"" + part.release + "\"", part.material);
  if (base.law == FrictionLaw::velocity_weakening && base.peak_coefficient < base.steady_coefficient) {
    faults.push_back({fmt::format("[solve.base] peak_coefficient = {} is below steady_coefficient = {}",
                                  base.peak_coefficient, base.steady_coefficient),
                      "friction would grow with speed", "Swap the two"});
  }
}

template <class Real>
Material<Real> make_material(const MaterialOptions& o) {
  const double shear = o.youngs_modulus / (2 * (1 + o.poisson_ratio));
  const double bulk = o.youngs_modulus / (3 * (1 - 2 * o.poisson_ratio));
  const ConeFit cone =
      fit_cone(o.cone, o.friction_angle * radians_per_degree, o.cohesion, o.dilatancy_angle * radians_per_degree);
  const ConeFit flow =
      fit_cone(o.cone, o.dilatancy_angle * radians_per_degree, 0, o.dilatancy_angle * radians_per_degree);
  // The cone's own tip bounds the tension; a frictionless cone has none.
  const double tip = cone.slope > 0 ? cone.cohesion / cone.slope : o.tension_cutoff;
  Material<Real> m;
  m.model = o.model;
  m.density = static_cast<Real>(o.density);
  m.shear_modulus = static_cast<Real>(shear);
  m.bulk_modulus = static_cast<Real>(bulk);
  m.wave_speed = static_cast<Real>(std::sqrt((bulk + 4 * shear / 3) / o.density));
  const double borne = 1 - o.pore_pressure_ratio;  // by the grains
  m.friction = static_cast<Real>(borne * cone.slope);
  m.dilatancy = static_cast<Real>(flow.slope);
  m.shear_cohesion = static_cast<Real>(cone.cohesion);
  m.tension = static_cast<Real>(std::min(tip, o.tension_cutoff));
  if (o.softens()) {
    const ConeFit left = fit_cone(o.cone, o.residual_friction_angle * radians_per_degree, o.residual_cohesion,
                                  o.dilatancy_angle * radians_per_degree);
    m.residual_friction = static_cast<Real>(borne * left.slope);
    m.residual_cohesion = static_cast<Real>(left.cohesion);
  }
  return m;
}

template <class Real>
Materials<Real> make_materials(const SolveOptions& options, double spacing, double layer_height) {
  Materials<Real> materials;
  int next = 0;
  const auto add = [&](const MaterialOptions& o) {
    Material<Real>& m = materials.list[next++];
    m = make_material<Real>(o);
    if (o.softens()) m.softening = static_cast<Real>(std::min(spacing, layer_height) / o.softening_slip);
  };
  add(options.material);
  for (const PartOptions& part : options.parts) add(part.material);
  while (next < most_materials) materials.list[next++] = materials.list[0];
  return materials;
}

double fastest_wave(const SolveOptions& options) {
  double fastest = make_material<double>(options.material).wave_speed;
  for (const PartOptions& part : options.parts)
    fastest = std::max(fastest, make_material<double>(part.material).wave_speed);
  return fastest;
}

template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options) {
  const BaseOptions& o = options.base;
  const bool by_angle = o.law == FrictionLaw::coulomb || o.law == FrictionLaw::voellmy;
  const double g = std::hypot(options.gravity[0], options.gravity[1], options.gravity[2]);
  const double borne = 1 - o.pore_pressure_ratio;  // by the grains
  BaseFriction<Real> f;
  f.law = o.law;
  f.uniform.coefficient =
      static_cast<Real>(borne * (by_angle ? std::tan(o.friction_angle * radians_per_degree) : o.steady_coefficient));
  f.uniform.peak = static_cast<Real>(borne * o.peak_coefficient);
  f.uniform.characteristic_speed = static_cast<Real>(o.characteristic_speed);
  if (o.law == FrictionLaw::voellmy) f.uniform.drag = static_cast<Real>(options.material.density * g / o.turbulence);
  if (o.uses("cohesion_Pa")) f.uniform.cohesion = static_cast<Real>(o.cohesion);
  return f;
}

SolveOptions with_preset(SolveOptions o) {
  if (o.preset != Preset::reference) return o;
  if (o.integrator != Integrator::quasi_static) o.integrator = Integrator::newmark;
  o.shape = ShapeKind::linear;
  o.transfer = Transfer::flip;
  o.transfer_time = 1e30;
  o.stress_update = StressUpdate::modified;
  o.implicit.alpha = 0.25;
  o.implicit.beta = 0.5;
  o.implicit.newton_iterations = 1;
  o.implicit.form = Operator::elements;
  o.implicit.preconditioner = Preconditioner::diagonal;
  return o;
}

template <class Real>
Walls<Real> make_walls(const std::vector<WallOptions>& options, double time, const WallFrame& frame) {
  Walls<Real> walls;
  for (const WallOptions& o : options) {
    const double now = time * (1 + 1e-12);  // events a rounding apart are one
    if (now < o.from || now >= o.to) continue;
    Wall<Real>& wall = walls.list[walls.count++];
    wall.axis = static_cast<int>(o.axis);
    wall.side = o.side == Side::above ? 1 : -1;
    const double position = o.position + o.speed * (time - o.from);
    const int a = wall.axis;
    wall.position = static_cast<Real>((position - frame.origin[a]) / frame.cell[a]);
    wall.kind = o.kind;
    wall.friction = static_cast<Real>(std::tan(o.friction_angle * radians_per_degree));
    wall.speed = static_cast<Real>(o.speed);
  }
  return walls;
}

template Walls<float> make_walls(const std::vector<WallOptions>&, double, const WallFrame&);
template Walls<double> make_walls(const std::vector<WallOptions>&, double, const WallFrame&);
template Material<float> make_material(const MaterialOptions&);
template Material<double> make_material(const MaterialOptions&);
template Materials<float> make_materials(const SolveOptions&, double, double);
template Materials<double> make_materials(const SolveOptions&, double, double);
template BaseFriction<float> make_base_friction(const SolveOptions&);
template BaseFriction<double> make_base_friction(const SolveOptions&);

}  // namespace talus::solver
