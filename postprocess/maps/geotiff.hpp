// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// What stands outside the computed domain, where nothing can be known.
enum class Outside { nodata, zero };

/// Write every product field as FOLDER/NAME.tif (cloud-optimised). Returns the files. Throws DataError. With
/// Outside::zero for tools that take nodata badly: all maps but the arrival time, whose zero would be a time.
std::vector<std::filesystem::path> write_geotiffs(const std::filesystem::path& folder, const Run& run,
                                                  Outside outside = Outside::nodata);

}  // namespace talus::postprocess
