// Text files of scattered elevations: x, y, z columns.
#pragma once

#include <filesystem>
#include <string_view>

#include "preprocess/terrain/geo_input.hpp"

namespace talus::preprocess {

/// True for the names an elevation column goes by: z, elevation, height, ...
bool is_z_name(std::string_view name);

/// Columns separated by commas, semicolons, tabs or blanks; '#' starts a comment. Throws DataError with the line.
ScatteredPoints read_point_table(const std::filesystem::path& file);

}  // namespace talus::preprocess
