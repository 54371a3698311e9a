// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of comma-separated values: members, and densities.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus::preprocess {

/// A field and where it begins, both counted from 1.
struct CsvField {
  std::string text;
  int line = 0, column = 0;
};

/// A file as RFC 4180 describes it: fields between commas, those in double quotes with anything in them, a doubled
/// quote for one; blank lines and lines that begin with # are skipped, blanks around a field too. A byte order mark is
/// passed over. Throws DataError with line and column: not readable, longer than 64 MB, an open quote, rows that have
/// not as many fields as the first.
std::vector<std::vector<CsvField>> read_csv(const std::filesystem::path& file);

/// A number of a file; throws DataError with line and column where it is none, or not finite.
double csv_number(const std::filesystem::path& file, const CsvField& field);

/// Whether the text of a field is a finite number.
bool is_csv_number(const CsvField& field);

/// A row of a table of probability density.
struct DensityRow {
  double value = 0, density = 0;
};

/// Values that grow and their densities, up to a factor; a first row of words is a header. Throws DataError with line
/// and column: fewer than two rows, other than two columns, values that do not grow, negative densities, or all 0.
std::vector<DensityRow> read_density(const std::filesystem::path& file);

}  // namespace talus::preprocess
