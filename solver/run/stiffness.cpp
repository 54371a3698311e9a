// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stiffness.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/energy_line.hpp"
#include "solver/scene/read_shaking.hpp"

namespace talus::solver {
StiffnessDemand lowest_stiffness(const Domain& domain, const SolveOptions& o) {
  StiffnessDemand demand;
  const double g = std::hypot(o.gravity[0], o.gravity[1], o.gravity[2]);
  const double head = energy_line_of(domain, o).largest_head(domain.terrain);
  const double start = std::hypot(o.initial_velocity[0], o.initial_velocity[1], o.initial_velocity[2]);
  demand.speed = std::sqrt(2 * g * head) + start + read_shaking(o.shaking).velocity_range();

  const MaterialOptions& m = o.material;
  const double wave_speed = make_material<double>(m).wave_speed;
  const double confined =
      m.density * wave_speed * wave_speed / m.youngs_modulus;  // modulus of confined compression over Young's
  const double needed = m.density * demand.speed * demand.speed / m.stiffness_strain / confined;
  const std::string why =
      fmt::format("the dynamic pressure at {:.3g} m/s, which the energy line{}, strains it by {:.3g} %", demand.speed,
                  o.shaking.acts() ? " and the shaking allow" : " allows", 100 * m.stiffness_strain);
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

SolveOptions settle_stiffness(const Domain& domain, SolveOptions o) {
  if (o.accuracy && o.material.stiffness_is_free()) {
    o.material.stiffness = StiffnessKind::automatic;
    o.material.stiffness_strain = strain_for(*o.accuracy);
  }
  if (o.material.stiffness != StiffnessKind::automatic) return o;
  const StiffnessDemand demand = lowest_stiffness(domain, o);
  const double full = o.material.youngs_modulus;
  log_info(demand.modulus < full
               ? fmt::format("stiffness: {:.3g} Pa instead of {:.3g} Pa, steps {:.3g} times as long: {}",
                             demand.modulus, full, std::sqrt(full / demand.modulus), demand.reason)
               : fmt::format("stiffness: {:.3g} Pa as given, for {}", full, demand.reason));
  return with_stiffness(o, demand);
}

}  // namespace talus::solver
