// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The counts of maps in counts.h5. Cells stand there block by block, in the order of the blocks' numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "common/ensemble/kept_cells.hpp"
#include "common/ensemble/tally.hpp"
#include "common/run/hdf5.hpp"

namespace talus {

/// Writes /cells; the order in which the places of all counts go into the file.
std::vector<std::size_t> write_cells(h5::File& file, const KeptCells& cells);

/// Reads it back: places are in the order of the file. Throws DataError where it is no such list.
KeptCells read_cells(const h5::File& file, const MapGrid& grid);

/// Writes /maps/NAME.
void write_tally(h5::File& file, const CountedMap& map, const MapTally& tally, const std::vector<std::size_t>& order);

/// What counts of a map are of.
struct TallyShape {
  std::size_t cells = 0;  ///< places
  Tallied tallied = Tallied::distribution;
  std::int64_t members = 0;  ///< that are counted
};

/// Reads it back. Throws DataError where counts contradict one another.
MapTally read_tally(const h5::File& file, const CountedMap& map, const TallyShape& shape);

}  // namespace talus
