#include "solver/run/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "solver/boundary/base_friction.hpp"

namespace talus::solver {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
/// What the mass should hold over what its bed asks, as tangents: with less, part of the shear stays in the mass (Frank
/// Slide on beds of 10 to 20 degrees, docs/decisions/0022-cone-of-simple-shear.md).
constexpr double recommended_ratio = 1.4;

/// The largest friction coefficient of the bed, of slow slip [-]; 0 where none rubs or the mass sticks.
double bed_friction(const Domain& domain, const SolveOptions& o) {
  const auto friction = make_base_friction<double>(o);
  if (friction.holds()) return 0;
  const double share = 1 - o.base.pore_pressure_ratio;
  for (const auto& [name, raster] : domain.bed) {
    if (name != "friction_angle_deg" || !o.base.uses(name)) continue;
    double steepest = 0;
    for (double angle : raster.values) steepest = std::isfinite(angle) ? std::max(steepest, angle) : steepest;
    return share * std::tan(steepest / degrees);
  }
  return friction.coefficient(friction.uniform, {});
}

/// The thickness at which strengths are compared [m]: the largest that is released.
double thickness(const Domain& domain) {
  double most = 0;
  for (double t : domain.release_thickness.values) most = std::isfinite(t) ? std::max(most, t) : most;
  return most;
}

/// What a material's numbers do not bear out; `table` is its table of the recipe.
void warn_of(const MaterialOptions& material, const std::string& table, double bed, double depth,
             std::vector<std::string>& lines) {
  if (material.model != MaterialModel::drucker_prager) return;
  const auto& law = material.options_of<DruckerPrager>();
  const double asked = law.asked_cone(law.friction_angle, law.cohesion).slope;
  if (asked > steepest_cone) {
    lines.push_back(
        fmt::format("{} friction_angle_deg = {:g} asks for the cone sqrt(J2) = {:.3f} p, under which grains would "
                    "carry tension. It is held to {:.3f} p, {:.1f} deg in simple shear",
                    table, law.friction_angle, asked, steepest_cone, std::atan(steepest_cone) * degrees));
  }
  const ConeFit fit = law.cone_of(law.friction_angle, law.cohesion);
  const double pressure = material.density * 9.81 * depth;
  const double held = (1 - law.pore_pressure_ratio) * fit.slope + (pressure > 0 ? fit.cohesion / pressure : 0);
  if (!(held < bed)) return;
  lines.push_back(fmt::format(
      "the mass gives way inside before it slides on its bed: in simple shear it holds {:.3f} of the pressure ({} "
      "friction_angle_deg = {:g}), the bed asks {:.3f} ({:.1f} deg). It moves as on a bed of {:.1f} deg. Give a "
      "friction angle of {:.1f} deg or more (cone = \"simple-shear\"; {:g} times the bed's tangent), or lower the "
      "bed's",
      held, table, law.friction_angle, bed, std::atan(bed) * degrees, std::atan(held) * degrees,
      std::atan(recommended_ratio * bed) * degrees, recommended_ratio));
}

}  // namespace

std::vector<std::string> warnings(const Domain& domain, const SolveOptions& options) {
  std::vector<std::string> lines;
  const double bed = bed_friction(domain, options), depth = thickness(domain);
  warn_of(options.material, "[solve.material]", bed, depth, lines);
  for (const PartOptions& part : options.parts)
    warn_of(part.material, fmt::format("[[solve.part]] \"{}\"", part.release), bed, depth, lines);
  return lines;
}

}  // namespace talus::solver
