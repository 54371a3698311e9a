#include "solver/run/stiffness.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/boundary/base_friction.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/read_shaking.hpp"

namespace talus::solver {
namespace {

/// The least friction the flow can meet: on its bed, or inside where the bed holds it.
double least_friction(const SolveOptions& o) {
  const auto base = make_base_friction<double>(o);
  if (base.holds()) return o.material.internal_friction();
  // Friction falls or grows with speed, if it changes at all, and is least under the thickest flow.
  const auto at_speed = [&](double speed) {
    return base.coefficient(base.uniform, {.speed = speed, .normal_stress = 1e41, .duration = 0, .load = 1e40});
  };
  return std::min(at_speed(0), at_speed(1e30));
}

struct Summit {
  double x = 0, y = 0, z = -1e30;
};

/// The highest place of what is released.
Summit summit_of(const Domain& domain) {
  Summit top;
  for (int row = 0; row < domain.grid.rows; ++row) {
    for (int column = 0; column < domain.grid.columns; ++column) {
      const double thickness = domain.release_thickness.at(column, row), ground = domain.terrain.at(column, row);
      if (!(thickness > 0) || !std::isfinite(ground)) continue;
      if (ground + thickness > top.z) top = {domain.grid.x(column), domain.grid.y(row), ground + thickness};
    }
  }
  return top;
}

}  // namespace

StiffnessDemand lowest_stiffness(const Domain& domain, const SolveOptions& o) {
  StiffnessDemand demand;
  const Summit top = summit_of(domain);
  const double g = std::hypot(o.gravity[0], o.gravity[1], o.gravity[2]), mu = least_friction(o);
  double head = 0;  // between the energy line and the ground [m]
  for (int row = 0; row < domain.grid.rows; ++row) {
    for (int column = 0; column < domain.grid.columns; ++column) {
      const double ground = domain.terrain.at(column, row);
      if (!std::isfinite(ground)) continue;
      head =
          std::max(head, top.z - ground - mu * std::hypot(domain.grid.x(column) - top.x, domain.grid.y(row) - top.y));
    }
  }
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

SolveOptions with_stiffness(SolveOptions o, const StiffnessDemand& demand) {
  o.material.youngs_modulus = demand.modulus;
  o.material.stiffness = StiffnessKind::as_given;
  for (PartOptions& part : o.parts)
    part.material.youngs_modulus = std::min(part.material.youngs_modulus, demand.modulus);
  return o;
}

}  // namespace talus::solver
