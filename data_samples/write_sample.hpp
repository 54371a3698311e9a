// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Samples as files: small GeoTIFFs and GeoJSON.
#pragma once

#include <filesystem>
#include <vector>

#include "data_samples/terrains.hpp"

namespace talus::samples {

/// Writes all files of a sample into `folder`, each aside and renamed; returns their paths. Throws DataError (not
/// writable, full).
std::vector<std::filesystem::path> write_sample(const std::filesystem::path& folder, const Sample& sample);

}  // namespace talus::samples
