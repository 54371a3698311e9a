// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/gis/geotiff.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/writer.hpp"

namespace talus::postprocess {

/// Paths of the GeoTIFFs of a run: a map each, then the deposit of each release.
Files geotiff_files(const std::filesystem::path& folder, const RunMaps& maps);

/// Write every product field as FOLDER/NAME.tif (cloud-optimised). Returns the files. Throws DataError.
Files write_geotiffs(const std::filesystem::path& folder, const Run& run);

/// Metadata of a map: title, scene, run, quantity, source.
RasterTags plain_tags(const Run& run, const std::string& quantity, const std::string& unit);

/// Patterns of the maps' names in the output folder, with `end` (".tif") as extension.
std::vector<std::string> names_of_maps(const std::string& end);

}  // namespace talus::postprocess
