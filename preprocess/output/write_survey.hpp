// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// OUT/survey: what the two elevation models say, for a GIS, for the score and for people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/stage/identity.hpp"
#include "preprocess/scene/prepare.hpp"

namespace talus::preprocess {

/// Writes before_aligned.tif, after_aligned.tif, difference.tif and difference_sigma.tif block by block (where the
/// later survey was moved: difference_unaligned.tif too), stable_ground.tif, and survey.json with the alignment, the
/// error and the volumes. With a slide also source_thickness.tif, sliding_surface.tif, deposit_surveyed.tif and
/// outlines.gpkg. Styles for QGIS beside all of them. Rasters and survey.json carry the id of `marks` (identity.hpp),
/// survey.json the mark of the recipe too. Returns the files; `lines` gains the volumes in words. Throws DataError.
std::vector<std::filesystem::path> write_survey(const std::filesystem::path& folder, const Survey& survey,
                                                const Prepared* prepared, const Facts& marks,
                                                std::vector<std::string>& lines);

/// Writes source_thickness.tif, sliding_surface.tif and outlines.gpkg: the sliding surface computed under an outline.
std::vector<std::filesystem::path> write_source(const std::filesystem::path& folder, const Prepared& prepared);

}  // namespace talus::preprocess
