// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether lengths and heights of a ground can be true: scale of its CRS, slopes, elevations.
#pragma once

#include <filesystem>

#include "common/map/raster.hpp"
#include "preprocess/options/elevation.hpp"

namespace talus::preprocess {

/// Measures the scale of the grid's CRS in its middle and its corners. Where lengths are off by more than a hundredth
/// ("false-lengths"), refuses it unless accepted; beyond a thousandth, warns. Volumes are off by twice as much.
/// `working_crs` is the recipe's, so that nothing is advised that is done.
void judge_lengths(const MapGrid& grid, const std::string& working_crs);

/// Refuses, unless accepted ("steep-ground"), ground where a tenth of a surface [m] is steeper than 50 degrees or some
/// of it is higher than 9,000 m, as where feet are taken for metres. On the terrain at hand (notes/plausibility.md) a
/// tenth is steeper than 26 to 43 degrees, and read as feet 58 to 72.
/// Warns of heights that are all within a thousandth of the distance across ("flat-ground"), or below all land
/// ("below-all-land").
void judge_heights(const Raster& surface, const std::filesystem::path& file, VerticalUnit unit);

/// Warns of a release whose mean thickness [m] is above 0.3 of the diameter of a circle of its area, and refuses it,
/// unless accepted, above that diameter ("thick-release"). Slides have 0.02 to 0.2.
void judge_thickness(const Raster& thickness, const std::string& name);

/// Warns where the median thickness [m] of a source's rim, between two surfaces that should meet there, is above 1.5
/// cells and half of its mean ("step-at-rim").
void warn_of_step_at_rim(const Raster& thickness, const std::filesystem::path& file);

/// Refuses, unless accepted ("fill-value"), heights [m] of which four cells or more hold the lowest or highest value
/// exactly, with a jump to all others of 50 m at least and of a quarter of what those span: no ground lies so, but a
/// value that stands for missing cells does. So do, where resampling mixed it with heights, cells of the most common
/// value with such a jump, and one of nine cells, to all that is seven to nine cells away; and ("mixed-voids") four
/// cells or more, up to six from missing ones, further from all at seven to nine than those span. Returns whether there
/// are any.
bool judge_fill_values(const Raster& heights, const std::filesystem::path& file);

}  // namespace talus::preprocess
