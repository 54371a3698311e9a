// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members that a file lists.
#pragma once

#include <filesystem>

#include "common/ensemble/member_table.hpp"

namespace talus::preprocess {

/// Puts the columns of a file of comma-separated values into a table: keys in the first row, members below. A column
/// in which anything is no number is one of words. Throws DataError with line and column: as read_csv(), no members,
/// more than most_members, keys that are empty or there twice, empty fields.
void take_listed(MemberTable& table, const std::filesystem::path& file);

}  // namespace talus::preprocess
