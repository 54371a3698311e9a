// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far landslides of a volume usually go: published regressions of the Fahrboeschung.
#pragma once

#include <span>

namespace talus {

/// log10(H/L) = offset + slope log10(V), V the volume [m3]; H/L, height over length of fall from crown to toe, is the
/// tangent of the Fahrboeschung (Heim 1932).
struct ReachRegression {
  const char* source;    ///< author and year
  const char* of;        ///< what it was fitted to
  double offset, slope;  ///< [-]
  double from_volume;    ///< below this it is not taken [m3]

  double tangent(double volume) const;  ///< H/L of a volume [-]
};

/// Scheidegger (1973), large rock slides, here from 1e5 m3 on; Corominas (1996), all 204 landslides, here from 1e4 m3.
std::span<const ReachRegression> reach_regressions();

/// The bounds that landslides of a volume hardly ever leave [-]: half of the smallest to twice the largest H/L of the
/// regressions that hold for it. Points scatter about either by less than that. Both 0 where none holds.
struct ReachBounds {
  double low = 0, high = 0;
};
ReachBounds usual_reach(double volume);

}  // namespace talus
