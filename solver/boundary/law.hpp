// The basal laws: what holds the mass back along its bed. A law is a type with static members; what each must have:
//
//   name                 in recipes
//   rubs                 whether it has a coefficient, and cohesion and pore pressure act with it
//   holds                whether what presses on the bed does not slip at all
//   asks_pressure        whether it looks at the normal stress
//   Options, uses        keys of the recipe with describe(); the keys that it looks at. A key that a raster can give
//                        is in common/domain/bed_numbers.hpp as well
//   words, sentence      the law in a line for plan and log, and in a sentence of the report ("at its bed acts ..."),
//                        from the options of all laws
//   count, numbers       numbers that kernels see, made from the options of all laws
//   coefficient          friction over normal stress for a slip
//   drag, drags          traction besides [Pa], and whether there is any
#pragma once

#include <algorithm>

#include "solver/boundary/laws/coulomb.hpp"
#include "solver/boundary/laws/none.hpp"
#include "solver/boundary/laws/stick.hpp"
#include "solver/boundary/laws/velocity_weakening.hpp"
#include "solver/boundary/laws/voellmy.hpp"

namespace talus {

/// Every basal law, in the order of the recipe's choices; nothing else lists them.
#define TALUS_FRICTION_LAWS(LAW)             \
  LAW(coulomb, Coulomb)                      \
  LAW(velocity_weakening, VelocityWeakening) \
  LAW(voellmy, Voellmy)                      \
  LAW(none, NoFriction)                      \
  LAW(stick, Stick)

#define TALUS_ENUMERATOR(name, Law) name,
#define TALUS_TYPE(name, Law) , Law
/// The law of a bed, by its number in the list.
enum class FrictionLaw { TALUS_FRICTION_LAWS(TALUS_ENUMERATOR) };
using FrictionLaws = LawListBehind<void TALUS_FRICTION_LAWS(TALUS_TYPE)>;
#undef TALUS_ENUMERATOR
#undef TALUS_TYPE

/// The most numbers that a law of the list has.
template <class Laws>
inline constexpr int most_numbers = 0;
template <class... Laws>
inline constexpr int most_numbers<LawList<Laws...>> = std::max({static_cast<int>(Laws::count)...});

/// This function returns visit(Law{}) for a law of the list.
template <class Laws = FrictionLaws, class Visit>
TALUS_HD auto visit_law(FrictionLaw law, const Visit& visit) {
  return visit_law(Laws{}, static_cast<int>(law), visit);
}

}  // namespace talus
