// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of maps, facts and findings in files of HDF5.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/hdf5.hpp"
#include "common/stage/findings.hpp"

namespace talus::h5 {

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

/// Writes findings as their JSON, data set /findings.
void write_findings(File& file, const std::vector<Finding>& findings);
/// Reads them back. Throws DataError: missing, or no findings.
std::vector<Finding> read_findings(const File& file);

}  // namespace talus::h5
