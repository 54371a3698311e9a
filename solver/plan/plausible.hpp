// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe asks that hardly any slide does: refused before the run unless the recipe insists on it by name
// (docs/notes/plausibility.md).
#pragma once

#include "common/stage/acceptance.hpp"
#include "common/stage/identity.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

struct Plan;

/// The largest strain that a mass may have under its own weight [-]: pressure at its bed over the modulus of confined
/// compression. With more its thickness and its density are not those that were released.
inline constexpr double most_weight_strain = 0.5;
/// The most times that the speed which the energy line allows may be that of waves: what is stopped at five times their
/// speed is under a pressure of 25 moduli.
inline constexpr double most_mach = 5;
/// The fastest waves that a solid may have [m/s]: in rock they reach 7 km/s, in diamond 18.
inline constexpr double fastest_solid_wave = 2e4;
/// The largest strain that a load may cause [-]: its force over the section of what it pulls at, over the modulus.
inline constexpr double most_load_strain = 1;

/// The strongest shaking that an accelerogram may have [m/s2]: five times standard gravity, below which
/// records of earthquakes stay.
inline constexpr double strongest_shaking = 5 * 9.80665;

/// The numbers of a scene by which it is judged.
struct ScenePlausibility {
  double weight_strain = 0;    ///< largest, of any material [-]
  double weight = 0;           ///< pressure at the bed there [Pa]
  double thickness = 0;        ///< of what lies there [m]
  double weighed_modulus = 0;  ///< Young's, of that material [Pa]
  double wave_speed = 0;       ///< of the slowest material [m/s]
  double fastest_wave = 0;     ///< of the fastest material [m/s]
  double speed = 0;            ///< that the energy line allows somewhere in the domain [m/s]
  double load_strain = 0;      ///< largest, of any load [-]
  double load = 0;             ///< its force [N]
  double load_volume = 0;      ///< of what it pulls at [m3]
  double shaking = 0;          ///< largest acceleration of the ground [m/s2]

  /// The speed that the energy line allows over that of the slowest waves [-].
  double mach() const { return wave_speed > 0 ? speed / wave_speed : 0; }
};

/// The numbers of a plan, points placed.
ScenePlausibility plausibility_of(const Plan& plan);

/// The function throws DataError for what is implausible in a scene, unless it is accepted: a mass that its own weight
/// squashes ("weight-strain"), waves far slower than the flow ("slow-waves"), waves faster than in any solid
/// ("fast-waves"), loads that squash what they pull at ("strong-loads"), ground that shakes as none does
/// ("strong-shaking").
void judge_scene(const ScenePlausibility& numbers, const SolveOptions& options, Acceptance& acceptance);

/// This function judges a plan by what its options accept, and throws one DataError of all that is refused. It returns
/// what was accepted. A body that tears is judged as the run goes on, and not here.
Acceptance judge_plan(const Plan& plan);

/// The names in [solve] accept that are judged before the run: all but that of a body that tears.
std::vector<std::string> accepted_before_run(const SolveOptions& options);

/// The function warns of the names in [solve] accept that no fact in `met`, of all runs that the recipe makes, is of.
void warn_of_unmet(const std::vector<std::string>& accept, const Facts& met);

}  // namespace talus::solver
