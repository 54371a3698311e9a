// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/water.hpp"

#include <cmath>

#include <fmt/format.h>

#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// The permeability of a mass of this solid fraction over the square of its grains' diameter, by Kozeny and Carman
/// (Carman 1937) [-].
double permeability_over_square(double solid) {
  const double pores = 1 - solid;
  return pores * pores * pores / (180 * solid * solid);
}

/// Grains of any mineral [kg/m3].
constexpr double lightest_grains = 1050, heaviest_grains = 5000;

/// Declares what water needs of the rest of the recipe.
void need_of_others(recipe::Visitor& v, const WaterOptions& w, const SolveOptions& o) {
  v.needs(o.mapping == Mapping::terrain_following,
          {"[solve.water] does not go with mapping = \"cartesian\"", "water flows along columns from the ground up",
           "Leave mapping out"});
  v.needs(o.every_material([](const MaterialOptions& m) {
    return m.model == MaterialModel::drucker_prager || m.model == MaterialModel::hencky ||
           m.model == MaterialModel::herschel_bulkley;
  }),
          {"[solve.water] does not go with every model of the mass",
           "what the strength of the others becomes in it is not known here",
           "Take model = \"drucker-prager\", \"herschel-bulkley\" or \"hencky\""});
  v.needs(o.every_material([](const MaterialOptions& m) { return !m.dilates(); }),
          {"[solve.water] beside dilatancy_angle_deg", "dilatancy follows from critical_solid_fraction there",
           "Leave dilatancy_angle_deg out"});
  const bool twice = o.base.pore_pressure_ratio > 0 || o.any_material([](const MaterialOptions& m) {
    return m.options_of<DruckerPrager>().pore_pressure_ratio > 0;
  });
  v.needs(!twice, {"[solve.water] beside pore_pressure_ratio", "water would carry its share twice",
                   "Give [solve.water] pressure_ratio instead"});
  const double grains = w.density_of_grains(o.material.density);
  v.needs(grains > lightest_grains && grains < heaviest_grains,
          {fmt::format("[solve.material] density_kg_m3 = {:g} with solid_fraction = {:g} and a fluid of {:g} kg/m3",
                       o.material.density, w.solid_fraction, w.fluid_density),
           fmt::format("the density is that of the mass full of water: its grains would have {:g} kg/m3", grains),
           fmt::format("Grains of 2650 kg/m3 make {:g}",
                       w.solid_fraction * 2650 + (1 - w.solid_fraction) * w.fluid_density)});
}

/// Declares the keys of still water around the mass, and what they need of the rest of the recipe.
void describe_still_water(recipe::Visitor& v, WaterOptions& w, const SolveOptions& o) {
  v.optional_number("level_m", w.level, recipe::any,
                    "elevation of still water: what of the mass lies below it weighs less and is dragged; no waves");
  v.number("added_mass", w.added_mass, recipe::not_negative, "share of the displaced water that moves with the mass");
  v.number("drag_coefficient", w.drag_coefficient, recipe::not_negative,
           "C of the drag C rho v^2 / 2 of the still water on the surface of the mass");
  const StepAbilities steps = abilities_of(o.asked_integrator());
  v.needs(!w.level || steps.obey_cfl, {"[solve.water] level_m does not go with this integrator",
                                       "steps of Newton's method know no still water", "Leave integrator out"});
  v.needs(!w.level || !o.energy_budget,
          {"[solve.water] level_m beside energy_budget", "the budget counts no buoyancy", "Leave energy_budget out"});
  v.needs(!w.level || o.material.density > w.fluid_density,
          {fmt::format("[solve.water] level_m with density_kg_m3 = {:g}", o.material.density), "the mass would float",
           "Give the density of the mass full of water"});
}

}  // namespace

double WaterOptions::density_of_grains(double density) const {
  // rho = m rho_s + (1 - m) (rho_f + fines (rho_s - rho_f))
  const double pores = 1 - solid_fraction;
  return (density - pores * (1 - fines) * fluid_density) / (solid_fraction + pores * fines);
}

double WaterOptions::density_of_fluid(double density) const {
  return fluid_density + fines * (density_of_grains(density) - fluid_density);
}

double WaterOptions::viscosity_of_fluid() const {
  return viscosity * (1 + 2.5 * fines + 10.05 * fines * fines + 0.00273 * std::expm1(16.6 * fines));
}

double WaterOptions::permeability_at_start() const {
  if (permeability) return *permeability;
  const double d = grain_diameter.value_or(0);
  return d * d * permeability_over_square(solid_fraction);
}

std::string WaterOptions::words(double density) const {
  std::string text =
      fmt::format("permeability {:.3g} m2, fluid of {:.4g} kg/m3 and {:.3g} Pa s, solid fraction {:g}",
                  permeability_at_start(), density_of_fluid(density), viscosity_of_fluid(), solid_fraction);
  if (critical_solid_fraction) text += fmt::format(", critical {:g}", *critical_solid_fraction);
  text +=
      pressure_ratio ? fmt::format(", pressure at first {:g} of the load", *pressure_ratio) : ", hydrostatic at first";
  if (table_depth > 0) text += fmt::format(" below {:g} m", table_depth);
  return text;
}

void WaterOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  using recipe::Range;
  v.optional_number("permeability_m2", permeability, recipe::not_negative,
                    "of the mass at the start; with it, or with grain_diameter_m, water flows between the grains");
  v.optional_number("grain_diameter_m", grain_diameter, recipe::positive,
                    "of grains that rule permeability (Kozeny-Carman, unless it is given) and dilatancy");
  v.number("solid_fraction", solid_fraction, Range{0.2, 0.8}, "share of the space that grains fill at the start");
  v.optional_number("critical_solid_fraction", critical_solid_fraction, Range{0.2, 0.8},
                    "that slow shear leads to: denser grains dilate and suck, looser ones contract and liquefy; "
                    "without it shear does not change the pressure");
  v.number("compressibility", compressibility, Range{0, 1, true},
           "a: stiffness of the grains' skeleton is solid fraction (effective stress + reference_stress_Pa) / a");
  v.number("reference_stress_Pa", reference_stress, recipe::positive, "sigma_0, of that stiffness");
  v.number("table_depth_m", table_depth, recipe::not_negative,
           "depth of the water table below the surface at the start, vertical; what lies above has no water");
  v.optional_number("pressure_ratio", pressure_ratio, recipe::fraction,
                    "pore pressure at the start over the load on it; without it the pressure is hydrostatic");
  v.number("fluid_density_kg_m3", fluid_density, recipe::positive, "density of the fluid without fines");
  v.number("viscosity_Pa_s", viscosity, recipe::positive, "viscosity of the fluid without fines");
  v.number("fines", fines, Range{0, 0.5},
           "share of the fluid's volume that is fine grains, which make it heavier and stiffer");
  v.number(
      "suction_Pa", suction, recipe::not_negative,
      "largest suction, at which air comes in: it adds to the strength of a mass that dilates or lacks water at its "
      "surface");
  const auto side = [&](const char* key, Drainage& value, const char* help) {
    recipe::choice(v, key, value, {{"drained", Drainage::drained}, {"sealed", Drainage::sealed}}, help);
  };
  side("bed", bed, "whether water goes through the bed");
  side("surface", surface, "whether it goes through the surface");
  describe_still_water(v, *this, all);
  v.needs(
      flows() || (!critical_solid_fraction && !pressure_ratio && !(table_depth > 0) && !(fines > 0) && !(suction > 0)),
      {"[solve.water] without permeability_m2 and grain_diameter_m", "no water flows, and its keys have no effect",
       "Give one of the two"});
  const auto thickens = [](const MaterialOptions& m) {
    return m.options_of<HerschelBulkley>().solid_fraction_exponent > 0;
  };
  v.needs(flows() || !all.any_material(thickens),
          {"[solve.material] solid_fraction_exponent without water", "the solid fraction does not change there",
           "Give [solve.water] permeability_m2"});
  if (flows()) need_of_others(v, *this, all);
}

Submersion<double> make_submersion(const SolveOptions& options) {
  const WaterOptions& w = options.water;
  if (!w.level) return {};
  const double lift = w.fluid_density / options.material.density;
  return {*w.level, lift, w.added_mass * lift, w.drag_coefficient * w.fluid_density / 2};
}

std::optional<PoreWater<double>> make_water(const SolveOptions& options) {
  const WaterOptions& w = options.water;
  if (!w.flows()) return {};
  const double density = options.material.density, d = w.grain_diameter.value_or(0);
  const double permeability = w.permeability_at_start(),
               grains = std::sqrt(permeability / permeability_over_square(w.solid_fraction));
  return PoreWater<double>{.fluid_density = w.density_of_fluid(density),
                           .viscosity = w.viscosity_of_fluid(),
                           .solid_fraction = w.solid_fraction,
                           .critical = w.critical_solid_fraction.value_or(0),
                           .permeability = permeability,
                           .compressibility = w.compressibility,
                           .reference = w.reference_stress,
                           .grain_inertia = w.density_of_grains(density) * d * d,
                           .suction = w.suction,
                           .meniscus = (1 - w.solid_fraction) * (d > 0 ? d : grains),
                           .friction = options.material.internal_friction(),
                           .drained_bed = w.bed == Drainage::drained,
                           .sealed_surface = w.surface == Drainage::sealed};
}

}  // namespace talus::solver
