// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a large elevation model that a scene needs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// Where a slide begins, and where its deposit is known to lie; in the working CRS.
struct SlideOutlines {
  std::vector<MapPolygon> release = {}, deposit = {};  // no release: not known where
  std::string doubt = {};                              // why it is not known, where there is a reason to say
  std::vector<Finding> findings = {};                  // of all of the models, which its part does not show
};

/// The corners of the rectangle of what lies above 0; none where nothing does.
std::vector<MapPolygon> corners_of(const Raster& thickness);

/// What `look` finds on the models in cells so wide that there are a million of them at most. Where it throws
/// DataError, that is the doubt.
SlideOutlines seen_from_afar(const std::vector<const Elevation*>& models, const MapGrid& whole, const Options& options,
                             const std::function<SlideOutlines(const std::vector<Raster>& surfaces)>& look);

/// The options with an extent where they name none and the models share more cells than a scene mostly needs. Where
/// the deposit is known that is release and deposit, with as much around them as they are long; else what lies on the
/// first model below a line from the highest of the release's rectangle, of 5 degrees (slides of 10^10 m3 come to 7 on
/// average; Corominas 1996) or of as many more, up to the 11 of [slides], as leave no more cells than that. Around it
/// as much as the rectangle is wide: a thick release spreads on level ground too. Erodible layers and voids that are to
/// be filled may lie anywhere: with them it is all of the model. `outlines` is asked on the whole working grid, where
/// that is large.
Options within_reach(const std::vector<const Elevation*>& models, Options options,
                     const std::function<SlideOutlines(const MapGrid& whole)>& outlines);

}  // namespace talus::preprocess
