// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of maps, and facts, in files of HDF5.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/hdf5.hpp"

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

}  // namespace talus::h5
