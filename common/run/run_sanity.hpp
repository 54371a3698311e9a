// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a finished run says of itself: whether its numbers are those that a slide can have.
#pragma once

#include <limits>
#include <string>

namespace talus {

/// The numbers of a run's sanity, NaN where they were not measured or nothing bounds them.
struct RunSanity {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double volume_error = unknown;  ///< volume in the domain and out of it over that at the start, less one [-]
  double volume_left = unknown;   ///< volume that left the domain over that at the start [-]
  double packing_p99 = unknown;   ///< largest over time: 99 % of the volume is packed no denser [-]
  double packing_max = unknown;   ///< largest over time of any cell [-]
  double energy_gain = unknown;   ///< largest rise of the mechanical energy over what was turned over [-]
  double speed_max = unknown;     ///< of any point at any time [m/s]
  double speed_bound = unknown;   ///< of a fall without loss from the highest point to the lowest ground reached [m/s]
  std::string words;              ///< "sane", or what is not
};

/// One of the numbers, wherever it goes.
struct SanityNumber {
  const char* name;  ///< in run.h5 and score.json
  double RunSanity::*value;
  const char* label;  ///< in score.txt and the report
  const char* unit;
  int decimals;
  const char* missing;  ///< why it may not be known
};

/// The numbers, in the order in which they are written.
inline constexpr SanityNumber sanity_numbers[] = {
    {"sanity_volume_error", &RunSanity::volume_error,
     "volume in the domain and out of it over that at the start, less 1", "", 12, "not measured"},
    {"sanity_volume_left", &RunSanity::volume_left, "volume that left the domain over that at the start", "", 4,
     "not measured"},
    {"sanity_packing_p99", &RunSanity::packing_p99, "packing that 99 % of the volume stays below", "", 2,
     "not measured"},
    {"sanity_packing_max", &RunSanity::packing_max, "densest packing", "", 2, "not measured"},
    {"sanity_energy_gain", &RunSanity::energy_gain, "largest rise of the energy over what was turned over", "", 4,
     "loads or walls that move do work on the mass"},
    {"sanity_speed_max_m_s", &RunSanity::speed_max, "fastest point", "m/s", 1, "not measured"},
    {"sanity_speed_bound_m_s", &RunSanity::speed_bound, "speed of a fall without loss", "m/s", 1,
     "loads or walls that move do work on the mass"},
};

}  // namespace talus
