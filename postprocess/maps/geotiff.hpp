#pragma once

#include <filesystem>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Write every product field as FOLDER/<name>.tif (cloud-optimised). Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_geotiffs(const std::filesystem::path& folder, const Run& run);

}  // namespace talus::postprocess
