// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// ASCII grids (Arc/Info's .asc) in the dialects that GDAL refuses or misreads, put right in memory before it sees them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace talus {

/// The header of an ASCII grid, whatever its dialect, as it was understood.
struct AsciiHeader {
  std::string text;         ///< in the usual form: ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value
  std::string nodata;       ///< as given; empty = none
  std::size_t body_at = 0;  ///< where the cells begin in the file
  double columns = 0, rows = 0;
  bool usual = true;  ///< GDAL reads the header right as it stands
};

/// Nullopt when the start of a file names no columns and rows, or no place and cell.
std::optional<AsciiHeader> ascii_header(std::string_view start_of_file);

}  // namespace talus

namespace talus::gdal {

/// True when a file begins as an ASCII grid does; its cells are not looked at.
bool begins_as_ascii_grid(const std::filesystem::path& file);

/// A file that may be an ASCII grid. Where its header names columns and rows it is one, and path() is what GDAL should
/// open: the file itself, or a stand-in in memory with the usual header. That covers keys in any order, case and
/// spelling (xllcentre, nbcols, nodata), behind its value (GeoClaw), one axis by corner and the other by centre, a
/// byte-order mark, comments, colons, and decimal commas and D-exponents; where single cells hold words for nodata (*,
/// NA) or are parted by commas or semicolons, all cells are in the stand-in, else they stay in the file. Throws
/// DataError naming line, column and word for a cell that is no number, for one more than the header names (thousands
/// parted by a sign make two of one), and for decimal commas that could all part thousands, and DataError of a file in
/// UTF-16.
class AsciiGrid {
 public:
  explicit AsciiGrid(const std::filesystem::path& file);
  AsciiGrid(AsciiGrid&&) = delete;
  AsciiGrid& operator=(AsciiGrid&&) = delete;
  ~AsciiGrid();

  bool is_one() const { return is_one_; }            ///< true when the file is an ASCII grid
  const std::string& path() const { return path_; }  ///< what GDAL opens instead of the file

 private:
  void stand_in(const std::filesystem::path& file, const std::string& header, std::size_t body_at);
  void stand_in(const std::filesystem::path& file, std::string text);
  void put(const std::string& name, std::string text);

  bool is_one_ = false;
  std::string path_, folder_;  // folder_: of the stand-in; empty = none
};

}  // namespace talus::gdal
