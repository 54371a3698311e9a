// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much was released, in one definition: that of talus-preprocess.
#pragma once

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// A release of vertical thickness t, on cells of map area A and of slope s.
struct ReleaseNumbers {
  double volume_if_normal = 0;     ///< sum of t A / cos s: were t normal to the slope [m3]
  double area = 0, true_area = 0;  ///< sum of A, and of A / cos s, where t > 0 [m2]
  double thickest = 0;             ///< [m]
  double thickest_normal = 0;      ///< t cos s [m]
};

/// The numbers of a thickness map on ground of slopes with these cosines; areas are of cells thicker than `limit` [m].
ReleaseNumbers numbers_of(const Raster& thickness, const std::vector<double>& cosine, double limit);

/// As talus-preprocess measured it on the release itself, and the run carries on. In a run that does not (an older
/// one): from the map of the thickness at the start, which is spread by the grid's shape functions, over cells thicker
/// than `limit` [m].
ReleaseNumbers release_numbers(const Run& run, double limit);

}  // namespace talus::postprocess
