// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What makes the maps ready for a GIS: styles beside them, outlines, the terrain below, and a project of QGIS.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What the files for a GIS are made from.
struct GisInput {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Hazard* hazard = nullptr;       ///< its layers are part of the project
  std::vector<ProjectGroup> more = {};  ///< further layers of the project, in `folder`
};

/// Beside `maps`, the GeoTIFFs in `folder`: NAME.qml for each of them, terrain.tif (ground before the failure) with its
/// hillshade, outlines.gpkg and SCENE.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_gis(const std::filesystem::path& folder,
                                             const std::vector<std::filesystem::path>& maps, const GisInput& input);

}  // namespace talus::postprocess
