// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an ensemble counts instead of keeping its runs. All counts and sums are whole numbers, so that they do not
// depend on the order of the members, and parts add up to the bits of the whole.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/map_fields.hpp"

namespace talus {
namespace h5 {
class File;
}

/// The cells of a grid of which counts are kept: whole blocks of cells, taken in as members come to them. A place is
/// where a cell stands in the arrays of counts. Blocks at the upper edges may reach beyond the grid.
class KeptCells {
 public:
  static constexpr int side = 16;  ///< of a block [cells]
  static constexpr std::size_t of_block = std::size_t{side} * side;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  KeptCells() = default;
  explicit KeptCells(const MapGrid& grid);

  std::size_t count() const { return blocks_.size() * of_block; }  ///< number of places
  std::size_t find(int column, int row) const;  ///< the place of a cell; none where its block is not kept
  std::size_t keep(int column, int row);        ///< the place of a cell, whose block is kept from now on
  /// The blocks that are kept, in the order of their places: numbers row by row, the southernmost row first.
  const std::vector<std::int32_t>& blocks() const { return blocks_; }
  std::size_t all_blocks() const { return slot_of_.size(); }  ///< number of blocks of the whole grid
  std::size_t keep_block(std::int32_t block);                 ///< keeps a block, too; the place of its first cell
  std::array<int, 2> cell(std::size_t place) const;           ///< column and row of a place
  /// Places block by block in the order of the blocks' numbers: the order of files.
  std::vector<std::size_t> in_order() const;
  /// Values by place, spread over the whole grid [rows * columns]; `absent` where none is kept.
  template <class T>
  std::vector<T> spread(const std::vector<T>& values, T absent) const;

 private:
  int columns_ = 0, rows_ = 0, blocks_across_ = 0;
  std::vector<std::int32_t> slot_of_;  ///< [blocks of the grid]; -1: not kept
  std::vector<std::int32_t> blocks_;
};

template <class T>
std::vector<T> KeptCells::spread(const std::vector<T>& values, T absent) const {
  std::vector<T> all(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), absent);
  for (std::size_t place = 0; place < values.size(); ++place) {
    const auto [column, row] = cell(place);
    if (column < columns_ && row < rows_)
      all[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] =
          values[place];
  }
  return all;
}

struct CountedMap {
  const char* name;    ///< as in run.h5: "peak_thickness"
  const char* unit;    ///< "m"
  MapMember values;    ///< of RunMaps, in that unit
  double quantum;      ///< values are counted in whole multiples of this [unit]
  std::int64_t low;    ///< the upper edge of the histogram's first bin [quanta]
  double ratio;        ///< of the edges of neighbouring bins
  bool early = false;  ///< a threshold is passed by a value below it, as a time of arrival is
};

/// The maps that an ensemble counts, in the order of files.
inline constexpr CountedMap counted_maps[] = {
    {"peak_thickness", "m", &RunMaps::peak_thickness, 1e-3, 10, 1.18},
    {"deposit_thickness", "m", &RunMaps::deposit_thickness, 1e-3, 10, 1.18},
    {"peak_speed", "m s-1", &RunMaps::peak_speed, 1e-2, 5, 1.16},
    {"peak_pressure", "kPa", &RunMaps::peak_pressure_kPa, 1e-2, 10, 1.2},
    {"arrival_time", "s", &RunMaps::arrival_time, 1e-2, 10, 1.18, true},
};
inline constexpr std::size_t counted_map_count = std::size(counted_maps);

/// Whether a value says that something came to its cell; NaN does not.
bool is_there(const CountedMap& map, double value);

/// Bins of a histogram: the first holds what is below the first edge, the last all beyond the last.
inline constexpr int histogram_bins = 64;

/// The edges between the bins [quanta], growing: whole numbers, the same on every machine.
using BinEdges = std::array<std::int64_t, histogram_bins - 1>;
/// Those of a map.
BinEdges bin_edges(const CountedMap& map);

/// Histograms of the cells that any member reached.
class CellHistograms {
 public:
  void grow(std::size_t cells) { row_of_.resize(cells, -1); }    ///< makes room for more cells
  void add(std::size_t cell, int bin, std::uint32_t count = 1);  ///< counts a value of a cell in a bin
  /// The counts of a cell, [histogram_bins]; empty where no member reached it.
  std::span<const std::uint32_t> of(std::size_t cell) const;

 private:
  std::vector<std::int32_t> row_of_;   ///< [cells]; -1: none
  std::vector<std::uint32_t> counts_;  ///< [rows * histogram_bins]
};

/// What is counted of each map.
enum class Tallied {
  distribution,  ///< sums and histograms too: members are draws of one thing, and have a mean and quantiles
  largest,       ///< what passes thresholds, and the largest: members are different things
};

/// The counts of one map over the members, by cell.
struct MapTally {
  std::vector<double> thresholds;                    ///< growing [unit of the map]
  Tallied tallied = Tallied::distribution;           ///< largest: sums and histograms are empty
  std::vector<std::vector<std::uint32_t>> exceeded;  ///< by threshold: members at or beyond it (early: at or before)
  std::vector<std::uint32_t> reached;                ///< members that have a value there
  std::vector<std::int32_t> extreme;                 ///< largest of those values (early: smallest), in quanta; -1: none
  std::vector<std::int64_t> sum, sum_of_squares;     ///< of those values, in quanta and their squares
  CellHistograms histograms;

  MapTally() = default;
  MapTally(std::vector<double> of_thresholds, std::size_t cells, Tallied what = Tallied::distribution);
  void grow(std::size_t cells);  ///< makes room for more cells, to which no member came yet
  /// Counts a member's value in a cell, `edges` those of the map; NaN, and 0 but for times, say that nothing came.
  void add(const CountedMap& map, const BinEdges& edges, std::size_t cell, double value);
  /// Adds counts of other members with the same thresholds and Tallied; `places`: where the other's cells stand here.
  void add(const CountedMap& map, const MapTally& other, std::span<const std::size_t> places);

  /// The largest value of any member (of a time the smallest) [unit]; 0 (of a time NaN) where none came.
  double largest(const CountedMap& map, std::size_t cell) const;
  /// The mean over `members` [unit]: those that did not reach the cell count as 0, but of a time, whose mean is over
  /// those that did (NaN: none).
  double mean(const CountedMap& map, std::size_t cell, std::int64_t members) const;
  /// The standard deviation, likewise, over all members as a population [unit].
  double deviation(const CountedMap& map, std::size_t cell, std::int64_t members) const;
  /// The value that a share 0 < p < 1 of the members does not exceed, by the histogram: linear within its bin, which is
  /// as wide as CountedMap::ratio says [unit]. Members that did not reach the cell are below all others (of a time:
  /// beyond all others, then NaN).
  double quantile(const CountedMap& map, std::size_t cell, double share, std::int64_t members) const;
};

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
