// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What CF wants to know of a projected CRS.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace talus::postprocess {

/// Attributes of a CF grid_mapping variable (CF-1.8, appendix F).
struct CfProjection {
  std::string grid_mapping_name;  ///< empty: a projection CF has no name for
  std::vector<std::pair<std::string, std::vector<double>>>
      numbers;  ///< parameters, angles in degrees, lengths in metres
  /// Names of the CRS, its geographic CRS, datum, ellipsoid and prime meridian: all of them or none, as CF asks.
  std::vector<std::pair<std::string, std::string>> words;
};

/// The attributes of a CRS. Projections not in CF's appendix give an empty name: readers then go by crs_wkt, which is
/// written in every case.
CfProjection cf_projection(const std::string& wkt);

}  // namespace talus::postprocess
