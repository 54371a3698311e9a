// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/stability.hpp"

#include <string>

#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// What of the recipe a search cannot do, and why.
struct BeyondSearch {
  std::string what;  ///< empty: nothing
  std::string why, mend;
};

/// The first of the materials that a search cannot weaken.
BeyondSearch beyond_materials(const SolveOptions& o) {
  BeyondSearch found;
  o.any_material([&](const MaterialOptions& m) {
    if (!found.what.empty()) return true;
    if (!m.steps_implicitly()) {
      found = {"model = \"" + m.name() + "\"", "its strength depends on the rate of shear, and at rest has none",
               "Take model = \"drucker-prager\""};
    } else if (!m.pressure_follows_volume()) {
      found = {"model = \"" + m.name() + "\"",
               "the volume change is averaged over cells, and its pressure does not follow from that alone",
               "Take model = \"hencky\" for what is to stay elastic"};
    } else if (m.softens()) {
      found = {"softening_slip_m", "a strength that falls on the way has one factor for its peak and another one after",
               "Leave it out, and give the strength that the factor is asked of"};
    }
    return false;
  });
  return found;
}

/// Whether something has a strength that can be divided.
bool has_strength(const SolveOptions& o) {
  const bool bed = visit_law(o.base.law, [](auto law) {
    return requires { law.weaken(nullptr, 1.0); };
  });
  return bed || o.any_material([](const MaterialOptions& m) {
    return visit_law(m.model, [](auto law) {
      return requires(typename decltype(law)::Options & options) { options.weaken(1.0); };
    });
  });
}

BeyondSearch beyond_search(const SolveOptions& o) {
  if (BeyondSearch material = beyond_materials(o); !material.what.empty()) return material;
  if (!visit_law(o.base.law, [](auto law) { return law.acts_at_rest; }))
    return {"[solve.base] law = \"" + o.base.law_name() + "\"", "its friction is that of a flow, not of rest",
            "Take law = \"coulomb\" with the friction at rest, \"stick\" or \"none\""};
  if (!has_strength(o))
    return {"no strength in the recipe", "elastic bodies on a bed that holds, or has no friction, have none to divide",
            "Take model = \"drucker-prager\" or law = \"coulomb\""};
  if (!(o.gravity_size() > 0)) return {"gravity_m_s2 = [0, 0, 0]", "nothing pulls at the ground", "Give gravity"};
  if (o.initial_speed() > 0)
    return {"initial_velocity_m_s", "a factor of safety is that of ground at rest", "Leave it out"};
  if (o.shaking.acts())
    return {"[solve.shaking]", "trials are equilibria, and a record that shakes the ground leaves none",
            "Leave one of the two out"};
  if (o.preset == Preset::reference)
    return {"preset = \"reference\"", "its one linear solve a step does not find an equilibrium", "Leave it out"};
  return {};
}

}  // namespace

void StabilityOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  v.flag("factor_of_safety", factor_of_safety,
         "find the factor by which strength can be divided before no equilibrium is left, instead of a run in time");
  v.number("tolerance", tolerance, recipe::Range{1e-4, 0.2}, "width of the bracket over its lower end");
  const BeyondSearch beyond = factor_of_safety ? beyond_search(all) : BeyondSearch{};
  v.needs(beyond.what.empty(),
          {"[solve.stability] factor_of_safety = true does not go with " + beyond.what, beyond.why, beyond.mend});
  const StabilityOptions usual;
  v.needs(factor_of_safety || tolerance == usual.tolerance,
          {"[solve.stability] is given without factor_of_safety = true", "tolerance has no effect",
           "Give factor_of_safety = true, or leave the table out"});
}

}  // namespace talus::solver
