// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of scattered elevations: x, y, z columns.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "preprocess/terrain/geo_input.hpp"

namespace talus::preprocess {

/// What the name of a column says of the heights in it.
struct HeightName {
  bool depth = false;  // below the ground; else elevations
  std::string unit;    // "m", "ft", "us ft", as metres_in() knows them; "" = not said
};

/// Reads z, elevation, elev, height, altitude or depth, in any case, alone or with a unit behind it ("depth_m", "Z
/// (ft)"); nullopt for any other name.
std::optional<HeightName> height_name(std::string_view name);

/// Columns separated by commas, semicolons, tabs or blanks; '#' starts a comment. Throws DataError with the line.
ScatteredPoints read_point_table(const std::filesystem::path& file, PointHeights heights = PointHeights::elevations);

}  // namespace talus::preprocess
