// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of members in a NetCDF file.
#pragma once

#include <string>
#include <vector>

#include "postprocess/ensemble/member_rows.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// Defines a group with a variable for each column. `called`: what a row is of, and the name of the dimension. Returns
/// the variables.
std::vector<int> define_members(Nc& nc, const MemberRows& rows, const char* group, const char* called);

/// Writes their values, once definitions have ended.
void fill_members(Nc& nc, const std::vector<int>& variables, const MemberRows& rows, const char* group);

/// A name in lower case, as attributes are.
std::string nc_lower(std::string text);

/// Defines the attributes of a file about all members: `title` is behind the scene's, `source` behind the version.
void describe_members_file(Nc& nc, const Ensemble& ensemble, const std::string& title, const std::string& source,
                           const Options& options, const std::string& command_line);

}  // namespace talus::postprocess
