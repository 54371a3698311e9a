// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What makes the maps ready for a GIS: styles beside them, outlines, the terrain below, and a project of QGIS.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/gis/outlines.hpp"
#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/options/writer.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Beside `maps`, the GeoTIFFs in `folder`: NAME.qml for each of them, terrain.tif (ground before the failure) with its
/// hillshade, outlines.gpkg and SCENE.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_gis(const std::filesystem::path& folder,
                                             const std::vector<std::filesystem::path>& maps, const Job& job);

/// Layers `footprint` (peak thickness above the footprint's threshold), `deposit` (final thickness above the deposit's
/// and above the limits of the classes), `pressure` (peak pressure above 1|3|5|10 kPa and so on), `release` and, where
/// there is one, `survey`.
std::vector<OutlineLayer> map_outlines(const Run& run, const Options& options, const std::optional<Survey>& survey);

/// `seconds` after `start` ("1903-04-29 04:10:00", UTC), to a millisecond: "1903-04-29T04:11:40.500Z".
std::string instant_after(const std::string& start, double seconds);

/// Which of `count` frames are shown, `most` of them at most: all, or evenly chosen with the first and the last.
std::vector<std::size_t> shown_frames(std::size_t count, std::size_t most);

/// Thickness at each frame, from maps/results.nc, in the classes of the deposit; not shown at first. Each lasts until
/// the next begins. Without layers where the run has fewer than two frames.
ProjectGroup flow_group(const Run& run, const Options& options);

/// Write what there is of intensity.tif, reach_cone.tif (the first cone), each with its style, reach.gpkg (the outline
/// of every cone, `angle_deg`, `h_over_l`) and buildings.gpkg (layers `buildings` and `obstacles`) into `folder`.
/// Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_hazard_maps(const std::filesystem::path& folder, const Run& run,
                                                     const Hazard& hazard);

/// The layers of a project that show them: outlines first, then rasters.
std::vector<ProjectGroup> hazard_groups(const Hazard& hazard);

}  // namespace talus::postprocess
