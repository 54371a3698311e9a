// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files between the stages: sealed (common/stage/checksum.hpp), with mark and format number, grids, facts,
// findings.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/hdf5.hpp"
#include "common/stage/findings.hpp"

namespace talus::h5 {

/// The shape of a map: rows, columns.
inline Dims shape_of(const MapGrid& grid) {
  return {static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)};
}

/// Writes a grid as attributes of a group that is there.
void write_grid(File& file, const std::string& group, const MapGrid& grid);
/// Reads it back. Throws DataError: missing, or what no grid can be.
MapGrid read_grid(const File& file, const std::string& group);

/// Writes pairs of key and value as numbered groups below a new group: keys may repeat, and values (a whole CRS) may be
/// longer than an attribute's name allows.
void write_facts(File& file, const std::string& group, const std::vector<std::pair<std::string, std::string>>& facts);
/// Reads them back.
std::vector<std::pair<std::string, std::string>> read_facts(const File& file, const std::string& group);

/// Writes a text of any length as the bytes of a data set.
void write_text(File& file, const std::string& path, const std::string& text);
/// Reads it back.
std::string read_text(const File& file, const std::string& path);

/// Writes windows of a grid, a row for each.
void write_windows(File& file, const std::string& path, const std::vector<CellWindow>& windows);
/// Reads them back.
std::vector<CellWindow> read_windows(const File& file, const std::string& path, std::size_t count);

/// Writes findings as their JSON, data set /findings.
void write_findings(File& file, const std::vector<Finding>& findings);
/// Reads them back. Throws DataError: missing, or no findings.
std::vector<Finding> read_findings(const File& file);

/// The attributes `format` and `format_version` of the root.
struct Format {
  const char* mark;          ///< "talus-run"
  const char* words;         ///< "a run of Talus"
  std::int64_t version = 1;  ///< to be raised when a reader would misread a file or miss something in it
};

/// Writes a file aside, whose content `write` puts in, seals it and gives it its name. Throws DataError with `mend`.
void write_sealed(const std::filesystem::path& path, const std::function<void(File&)>& write,
                  const std::string& mend = "");

void set_format(File& file, const Format& format);

/// Opens a file for reading once its seal has been checked. Throws DataError: missing, damaged, not sealed.
File open_sealed(const std::filesystem::path& path, const Naming& naming);

/// The same; refuses files of another mark or format number as well.
File open_sealed(const std::filesystem::path& path, const Naming& naming, const Format& format);

}  // namespace talus::h5
