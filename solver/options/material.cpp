#include "solver/options/material.hpp"

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

bool MassOptions::any_material(const std::function<bool(const MaterialOptions&)>& is) const {
  return is(material) ||
         std::any_of(parts.begin(), parts.end(), [&](const PartOptions& part) { return is(part.material); });
}

void MassOptions::describe(recipe::Visitor& v) {
  recipe::list(v, "part", parts, "a release of another material than [solve.material]");
  v.enter("material", "the sliding mass");
  material.describe(v);
  v.leave();
}

void MassOptions::check(std::vector<Fault>& faults) const {
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
Materials<Real> make_materials(const MassOptions& options, double spacing, double layer_height) {
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

double fastest_wave(const MassOptions& options) {
  double fastest = make_material<double>(options.material).wave_speed;
  for (const PartOptions& part : options.parts)
    fastest = std::max(fastest, make_material<double>(part.material).wave_speed);
  return fastest;
}

template Material<float> make_material(const MaterialOptions&);
template Material<double> make_material(const MaterialOptions&);
template Materials<float> make_materials(const MassOptions&, double, double);
template Materials<double> make_materials(const MassOptions&, double, double);

}  // namespace talus::solver
