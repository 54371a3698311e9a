// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The constitutive laws. A law is a type with static members; what each must have:
//
//   name                      in recipes
//   keeps_strain              whether a point's `elastic` is its logarithmic strain (else it is what `advance` makes)
//   pressure_follows_volume   whether the volume change alone decides the pressure, as B-bar needs
//   stiffness_is_free         whether the flow hardly depends on the elastic moduli (stiffness = "auto" may lower them)
//   steps_implicitly          whether Newton's iterations take it; else recipes with implicit integrators are refused
//   LoadedAs, after_loading   the law that takes its part while gravity is loaded, and what remains of its strain
//   Options                   keys of the recipe: describe(), softens(), dilates(); names of keys and members are the
//                             law's own, for MaterialOptions has those of all laws
//   Options::internal_friction  only where the strength is friction: its coefficient in slow shear
//   Options::cones, held_share  likewise: cones that keys ask for, the steepest last; share of the pressure held inside
//   Options::density_fault    only where a density of the mass can contradict the law's keys
//   Options::weaken           only where a search for the factor of safety can divide the strength
//   words, sentence           the material in a line for plan and log, and in a sentence of the report ("It is ...")
//   Numbers<Real>, numbers()  what kernels see of the options; soften(), round_tip()
//   stress, energy            Kirchhoff stress [Pa] and elastic energy per initial volume [J/m3] of a state
//   settle, respond           where keeps_strain: end of a step whose trial strain is in the state; principal stresses
//                             of a trial and their derivatives. Both are given the length of the step
//   advance, nominal_stress   elsewhere: the whole step; nominal stress and its tangent
//   stiffening                only where a stretched point has faster waves: their modulus over that at rest
//   largest_strain            only where the nominal stress falls beyond a stretch: the logarithm of that stretch
#pragma once

#include "solver/material/laws/herschel_bulkley.hpp"
#include "solver/material/laws/mu_of_i.hpp"

namespace talus {

/// Every constitutive law, in the order of the recipe's choices; nothing else lists them.
// clang-format off
#define TALUS_MATERIAL_LAWS(LAW)         \
  LAW(drucker_prager, DruckerPrager)     \
  LAW(hencky, Hencky)                    \
  LAW(corotated, Corotated)              \
  LAW(linear_elastic, LinearElastic)     \
  LAW(neo_hookean, NeoHookean)           \
  LAW(mu_of_i, MuOfI)                    \
  LAW(herschel_bulkley, HerschelBulkley)
// clang-format on

#define TALUS_ENUMERATOR(name, Law) name,
#define TALUS_TYPE(name, Law) , Law
enum class MaterialModel { TALUS_MATERIAL_LAWS(TALUS_ENUMERATOR) };
using MaterialLaws = LawListBehind<void TALUS_MATERIAL_LAWS(TALUS_TYPE)>;
#undef TALUS_ENUMERATOR
#undef TALUS_TYPE

/// The model that means `Law` in the list `Laws`.
template <class Law, class Laws = MaterialLaws>
inline constexpr MaterialModel model_of = static_cast<MaterialModel>(Laws::template index_of<Law>());

/// This function returns visit(Law{}) for the law of a model.
template <class Laws = MaterialLaws, class Visit>
TALUS_HD auto visit_law(MaterialModel model, const Visit& visit) {
  return visit_law(Laws{}, static_cast<int>(model), visit);
}

/// The law that takes a model's part while gravity is loaded.
inline MaterialModel model_while_loading(MaterialModel model) {
  return visit_law(model, [](auto law) { return model_of<typename decltype(law)::LoadedAs>; });
}

/// The part of the elastic state that gravity loading ended with, with which a point goes on.
inline Sym3<double> after_loading(MaterialModel model, const Sym3<double>& loaded) {
  return visit_law(model, [&](auto law) { return law.after_loading(loaded); });
}

}  // namespace talus
