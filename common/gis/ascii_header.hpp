// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The header of an ASCII grid, whatever its dialect.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace talus {

/// A header as it was understood.
struct AsciiHeader {
  std::string text;         ///< in the usual form: ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value
  std::string nodata;       ///< as given; empty = none
  std::size_t body_at = 0;  ///< where the cells begin in the file
  bool usual = true;        ///< GDAL reads the header right as it stands
};

/// Nullopt when the start of a file names no columns and rows, or no place and cell: then it is none that is known
/// here.
std::optional<AsciiHeader> ascii_header(std::string_view start_of_file);

/// "1,5" and "1.5D3" as people mean them; nullopt when it is no number.
std::optional<double> ascii_number(std::string_view word);

/// "*", "NA", "null" and the like.
bool is_word_for_nodata(std::string_view word);

}  // namespace talus
