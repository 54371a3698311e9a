// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How each map is drawn in a GIS: the thresholds of hazard work, in classes.
#pragma once

#include <string>
#include <vector>

#include "common/qgis/style.hpp"
#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Limits of pressure classes [kPa]: of 1|3|5|10 and the powers of ten above those that fit the largest of `values`
/// (fitting_limits), the first four always kept.
std::vector<double> pressure_limits(const std::vector<double>& values);

/// Limits of speed classes [m/s]: of 0.5|1|5|10|25|50|100 those that fit the largest of `values` (fitting_limits).
std::vector<double> speed_limits(const std::vector<double>& values);

/// Limits of thickness classes for `values` [m]: as given in the recipe, or by the thickest of them.
std::vector<double> thickness_limits(const std::vector<double>& given, const std::vector<double>& values);

/// Round times up to the last of `values` [s], six at most.
std::vector<double> time_limits(const std::vector<double>& values);

/// Class limits of a map of the run; `given_classes` are the thickness classes of the recipe, empty = none.
std::vector<double> map_limits(const MapField& field, const RunMaps& maps, const std::vector<double>& given_classes);

/// The style of a map by its name (file name without extension); `given_classes` are those of the recipe. Throws
/// std::logic_error for a name that is no map of a run.
RasterStyle map_style(const std::string& name, const RunMaps& maps, const std::vector<double>& given_classes);

}  // namespace talus::postprocess
