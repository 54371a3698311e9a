// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// ASCII grids (Arc/Info's .asc) in the dialects that GDAL refuses or misreads, put right in memory before it sees them.
#pragma once

#include <filesystem>
#include <string>

namespace talus::gdal {

/// True when a file begins as an ASCII grid does; its cells are not looked at.
bool begins_as_ascii_grid(const std::filesystem::path& file);

/// A file that may be an ASCII grid. Where its header names columns and rows it is one, and path() is what GDAL should
/// open: the file itself, or a stand-in in memory with the usual header. That covers keys in any order, case and
/// spelling (xllcentre, nbcols, nodata), one axis by corner and the other by centre, a byte-order mark, comments,
/// colons, and decimal commas and D-exponents; where single cells hold words for nodata (*, NA) or are parted by commas
/// or semicolons, all cells are in the stand-in, else they stay in the file. Throws DataError naming line and word for
/// a cell that is no number.
class AsciiGrid {
 public:
  explicit AsciiGrid(const std::filesystem::path& file);
  AsciiGrid(AsciiGrid&&) = delete;
  AsciiGrid& operator=(AsciiGrid&&) = delete;
  ~AsciiGrid();

  /// True when the file is an ASCII grid.
  bool is_one() const { return is_one_; }
  /// What GDAL opens instead of the file.
  const std::string& path() const { return path_; }

 private:
  void stand_in(const std::filesystem::path& file, const std::string& header, std::size_t body_at);
  void stand_in(const std::filesystem::path& file, std::string text);
  void put(const std::string& name, std::string text);

  bool is_one_ = false;
  std::string path_, folder_;  // folder_: of the stand-in; empty = none
};

}  // namespace talus::gdal
