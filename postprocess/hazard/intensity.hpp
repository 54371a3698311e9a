// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Classes of intensity, by guidelines or the analyst's own limits.
#pragma once

#include <string>
#include <vector>

#include "common/map/colours.hpp"
#include "common/run/map_fields.hpp"
#include "postprocess/options/hazard.hpp"

namespace talus::postprocess {

/// One class of intensity.
struct IntensityClass {
  int code = 0;       ///< on the map
  std::string name;   ///< "medium"
  std::string words;  ///< the limits: "thickness >= 1 m and speed >= 1 m/s"
  Colour colour;
  double area = 0;  ///< of the cells of this class, in plan [m2]
};

/// A map of codes: NaN outside the domain, 0 where nothing came.
struct IntensityMap {
  std::string guideline;  ///< as recipes call it
  std::string source;     ///< whose limits they are
  std::vector<IntensityClass> classes;
  std::vector<double> codes;  ///< [rows * columns]
};

/// The class of every cell that the flow reached, thicker than the run's threshold, by the largest thickness h, speed v
/// and pressure p there over time, and by their product h v. The largest of h and of v need not come together: h v is
/// a bound, on the safe side.
///
/// - swiss-debris-flow (BWW, BRP & BUWAL 1997): strong where h >= 1 m and v >= 1 m/s, else medium; there is no weak.
/// - swiss-flood (BWW, BRP & BUWAL 1997): strong where h >= 2 m or h v >= 2 m2/s, medium from 0.5, else weak.
/// - swiss-avalanche (BFF & SLF 1984): strong where p >= 30 kPa, medium from 3 kPa, else weak.
/// - debris-flow-concrete (Kang & Kim 2014): what reinforced concrete suffers: extensive damage where p >= 100 kPa,
///   moderate from 35 kPa, else slight.
/// - debris-flow-other (Kang & Kim 2014): what other buildings suffer: complete destruction where p >= 30 kPa,
///   extensive damage from 15 kPa, else slight.
/// - own: class k where any, or all, of the quantities given reach their k-th limit; none below the first.
IntensityMap intensity_of(const RunMaps& maps, const IntensityOptions& options);

}  // namespace talus::postprocess
