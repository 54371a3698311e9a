// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/stiffness.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace talus::solver {

StiffnessDemand lowest_stiffness(const SolveOptions& o, const SpeedBound& bound) {
  StiffnessDemand demand;
  const MaterialOptions& m = o.material;
  const double wave_speed = make_material<double>(m).wave_speed;
  const double confined =
      m.density * wave_speed * wave_speed / m.youngs_modulus;  // modulus of confined compression over Young's
  const double under_weight = std::min(m.stiffness_strain, o.accuracy.value_or(1)) / 2;
  const double for_speed = m.density * bound.speed * bound.speed / m.stiffness_strain / confined,
               for_weight = m.density * o.gravity_size() * bound.depth / under_weight / confined;
  const double needed = std::max(for_speed, for_weight);
  const std::string why =
      for_speed < for_weight
          ? fmt::format("the weight of {:.3g} m strains it by {:.3g} %", bound.depth, 100 * under_weight)
          : fmt::format("the dynamic pressure at {:.3g} m/s, which the energy line{}, strains it by {:.3g} %",
                        bound.speed, o.shaking.acts() ? " and the shaking allow" : " allows", 100 * m.stiffness_strain);
  demand.modulus = std::min(needed, m.youngs_modulus);
  demand.reason =
      needed < m.youngs_modulus ? why : fmt::format("it is no more than is needed: at {:.3g} Pa {}", needed, why);
  return demand;
}

double strain_for(double accuracy) { return std::clamp(200 * accuracy * accuracy, 1e-3, 0.1); }

SolveOptions with_stiffness(SolveOptions o, const StiffnessDemand& demand) {
  o.material.youngs_modulus = demand.modulus;
  o.material.stiffness = StiffnessKind::as_given;
  o.material.stiffness_strain = default_stiffness_strain;  // it has done its work
  for (PartOptions& part : o.parts)
    part.material.youngs_modulus = std::min(part.material.youngs_modulus, demand.modulus);
  return o;
}

bool leaves_stiffness(const SolveOptions& options) {
  const MaterialOptions& material = options.material;
  return material.stiffness == StiffnessKind::automatic || (options.accuracy && material.stiffness_is_free());
}

SolveOptions settle_stiffness(SolveOptions o, const SpeedBound& bound, std::vector<std::string>& reasons) {
  if (o.accuracy && o.material.stiffness_is_free()) {
    o.material.stiffness = StiffnessKind::automatic;
    o.material.stiffness_strain = strain_for(*o.accuracy);
  }
  if (o.material.stiffness != StiffnessKind::automatic) return o;
  const StiffnessDemand demand = lowest_stiffness(o, bound);
  const double full = o.material.youngs_modulus;
  reasons.push_back(demand.modulus < full
                        ? fmt::format("stiffness: {:.3g} Pa instead of {:.3g} Pa, steps {:.3g} times as long: {}",
                                      demand.modulus, full, std::sqrt(full / demand.modulus), demand.reason)
                        : fmt::format("stiffness: {:.3g} Pa as given, for {}", full, demand.reason));
  return with_stiffness(o, demand);
}

}  // namespace talus::solver
