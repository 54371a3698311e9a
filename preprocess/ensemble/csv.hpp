// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of comma-separated values: members, and densities.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/ensemble/member_table.hpp"

namespace talus::preprocess {

/// Reads the number that a text is; none where it is none.
using NumberReader = std::optional<double> (*)(std::string_view text);

/// A column of a key: numbers where all texts are, else words.
MemberColumn column_of(std::string key, const std::vector<std::string>& texts, NumberReader number);

struct DensityRow {
  double value = 0, density = 0;
};

/// Values that grow and their densities, up to a factor; a first row of words is a header. Throws DataError with line
/// and column: fewer than two rows, other than two columns, values that do not grow, negative densities, or all 0.
std::vector<DensityRow> read_density(const std::filesystem::path& file);

/// Puts the columns of a file of comma-separated values into a table: keys in the first row, members below. A column
/// in which anything is no number is one of words. Throws DataError with line and column: not readable, an open quote,
/// no members, more than most_members, keys that are empty or there twice, empty fields.
void take_listed(MemberTable& table, const std::filesystem::path& file);

}  // namespace talus::preprocess
