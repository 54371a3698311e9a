#include "solver/options/bed.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "solver/options/solve.hpp"

namespace talus::solver {

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

void BaseOptions::check(std::vector<Fault>& faults) const {
  if (law == FrictionLaw::velocity_weakening && peak_coefficient < steady_coefficient) {
    faults.push_back({fmt::format("[solve.base] peak_coefficient = {} is below steady_coefficient = {}",
                                  peak_coefficient, steady_coefficient),
                      "friction would grow with speed", "Swap the two"});
  }
}

template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options) {
  const BaseOptions& o = options.base;
  const bool by_angle = o.law == FrictionLaw::coulomb || o.law == FrictionLaw::voellmy;
  const double g = std::hypot(options.gravity[0], options.gravity[1], options.gravity[2]);
  const double borne = 1 - o.pore_pressure_ratio;  // by the grains
  BaseFriction<Real> f;
  f.law = o.law;
  f.uniform.coefficient = static_cast<Real>(
      borne * (by_angle ? std::tan(o.friction_angle * (std::numbers::pi / 180)) : o.steady_coefficient));
  f.uniform.peak = static_cast<Real>(borne * o.peak_coefficient);
  f.uniform.characteristic_speed = static_cast<Real>(o.characteristic_speed);
  if (o.law == FrictionLaw::voellmy) f.uniform.drag = static_cast<Real>(options.material.density * g / o.turbulence);
  if (o.uses("cohesion_Pa")) f.uniform.cohesion = static_cast<Real>(o.cohesion);
  return f;
}

template BaseFriction<float> make_base_friction(const SolveOptions&);
template BaseFriction<double> make_base_friction(const SolveOptions&);

}  // namespace talus::solver
