// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The basal laws: what holds the mass back along its bed. A law is a type with static members; what each must have:
//
//   name                 in recipes
//   rubs                 whether it has a coefficient, and cohesion and pore pressure act with it
//   holds                whether what presses on the bed does not slip at all
//   asks_pressure        whether it looks at the normal stress of the base node
//   asks_column          whether its coefficient follows from load, weight and mean speed of the column
//   acts_at_rest         whether a search for the factor of safety takes it
//   friction_key         the key that alone decides its friction; empty where several do
//   Options, uses        keys of the recipe with describe(); the keys that it looks at. A key that a raster can give
//                        is in common/domain/bed_numbers.hpp as well
//   check                what its keys need of those of other laws
//   words, sentence      the law in a line for plan and log, and in a sentence of the report ("at its bed acts ..."),
//                        from the options of all laws
//   count, numbers       numbers of a place that kernels see, made from the options of all laws
//   constant_count, constants  those of the scene
//   weaken               only where that search can divide its strength: divides the numbers of a place
//   coefficient          friction over normal stress for a slip
//   drag, drags          traction that grows with speed [Pa], and whether there is any
//   yield, yields        traction besides friction at any speed [Pa], and whether there is any
//
// BasalLaw has what a law need not say. Numbers of a place lie beside every column where there are rasters; what no
// raster gives is a number of the scene.
#pragma once

#include <algorithm>

#include "solver/boundary/laws/coulomb.hpp"
#include "solver/boundary/laws/frictionless.hpp"
#include "solver/boundary/laws/pouliquen.hpp"
#include "solver/boundary/laws/samosat.hpp"
#include "solver/boundary/laws/table.hpp"
#include "solver/boundary/laws/velocity_weakening.hpp"

namespace talus {

/// Every basal law, in the order of the recipe's choices; nothing else lists them.
#define TALUS_FRICTION_LAWS(LAW)             \
  LAW(coulomb, Coulomb)                      \
  LAW(velocity_weakening, VelocityWeakening) \
  LAW(voellmy, Voellmy)                      \
  LAW(samosat, Samosat)                      \
  LAW(pouliquen, Pouliquen)                  \
  LAW(table, FrictionTable)                  \
  LAW(none, NoFriction)                      \
  LAW(stick, Stick)

#define TALUS_ENUMERATOR(name, Law) name,
#define TALUS_TYPE(name, Law) , Law
enum class FrictionLaw { TALUS_FRICTION_LAWS(TALUS_ENUMERATOR) };
using FrictionLaws = LawListBehind<void TALUS_FRICTION_LAWS(TALUS_TYPE)>;
#undef TALUS_ENUMERATOR
#undef TALUS_TYPE

/// The most numbers that a law of the list has.
template <class Laws>
inline constexpr int most_numbers = 0;
template <class... Laws>
inline constexpr int most_numbers<LawList<Laws...>> = std::max({static_cast<int>(Laws::count)...});
/// The most numbers of the scene that a law of the list has, and one at least: there are no arrays of none.
template <class Laws>
inline constexpr int most_constants = 1;
template <class... Laws>
inline constexpr int most_constants<LawList<Laws...>> = std::max({1, static_cast<int>(Laws::constant_count)...});

/// This function returns visit(Law{}) for a law of the list.
template <class Laws = FrictionLaws, class Visit>
TALUS_HD auto visit_law(FrictionLaw law, const Visit& visit) {
  return visit_law(Laws{}, static_cast<int>(law), visit);
}

}  // namespace talus
