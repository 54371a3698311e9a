// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// From when time counts where nobody says when the failure began, UTC: CF asks for a date, and every reader takes
/// this one.
inline constexpr const char* nominal_start = "1970-01-01 00:00:00";

/// What a NetCDF file says of its making.
struct NetcdfNotes {
  std::string institution;   ///< empty: "not stated"
  std::string command_line;  ///< for history
  std::string start{};       ///< when the failure began, UTC, "1903-04-29 04:10:00"; empty: not known
};

/// Write `file` (aside, renamed): NetCDF-4 after CF-1.8, dimensions (time, y, x), y rising with row (south first).
/// Variables: the product fields, bed elevation, thickness at the start and over time, depth of erosion and the deposit
/// of each release where there are any, bounds of the cells, grid mapping `crs` where the run has a CRS. All double
/// with _FillValue -9999 and deflate. Throws DataError (disk full).
void write_netcdf(const std::filesystem::path& file, const Run& run, const NetcdfNotes& notes);

}  // namespace talus::postprocess
