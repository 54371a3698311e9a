// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of an ensemble, drawn as [ensemble] says.
#pragma once

#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"

namespace talus::preprocess {

/// Draws the members: their number, and the value of each key in each of them; own_domain and provenance are left to
/// the caller. Equal options give equal tables. Throws RecipeError where the design does not go with what varies, and
/// as Marginal, copula_of() and unit_design() do; DataError as read_csv() does.
MemberTable draw_members(const EnsembleOptions& options);

/// What people read of a table: the design and its number of members, and smallest value, mean and largest of each key.
std::vector<std::string> as_lines(const MemberTable& table, const EnsembleOptions& options);

}  // namespace talus::preprocess
