// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The history of a run as files: tables of gauges and sections, NetCDF.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// For each kind of place that has columns ("gauge", "section"): a table with a row for every record and place, with
/// time, the place's name and what was measured there, in columns whose names carry their units.
std::vector<std::pair<std::string, std::string>> place_tables(const RunHistory& history);

/// The history as the bytes of a NetCDF-4 file after CF-1.8: a variable over `time` for every column, with its unit,
/// and for gauges, sections and obstacles what is measured (`long_name`) and where (`place`). `start`: when the failure
/// began, UTC; empty: not known. Records without a value hold _FillValue.
std::string history_netcdf(const Run& run, const std::string& start);

}  // namespace talus::postprocess
