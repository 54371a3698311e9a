// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/slide_maps.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "common/map/crop.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

void add_largest(std::vector<EnsembleMap>& maps, std::size_t tally) {
  const CountedMap& map = counted_maps[tally];
  const std::string words = words_of(map);
  maps.push_back({Kind::largest, tally, 0, nan, map.early ? "earliest_arrival" : std::string("largest_") + map.name,
                  (map.early ? "Earliest " : "Largest ") + words + " of any slide", map.unit});
}

void add_counts(std::vector<EnsembleMap>& maps, const Ensemble& ensemble, std::size_t tally) {
  const CountedMap& map = counted_maps[tally];
  const std::vector<double>& thresholds = ensemble.counts.maps[tally].thresholds;
  for (std::size_t n = 0; n < thresholds.size(); ++n) {
    std::string unit = unit_words(map.unit);
    std::replace(unit.begin(), unit.end(), '/', '_');
    const std::string name =
        fmt::format("{}_{}_{:g}_{}", map.name, map.early ? "before" : "above", thresholds[n], unit);
    const std::string words = fmt::format("{} of {}", words_of(map), threshold_words(map, thresholds[n]));
    maps.push_back({Kind::count, tally, n, thresholds[n], "number_" + name, "Number of slides with " + words, "1"});
    maps.push_back({Kind::share, tally, n, thresholds[n], "share_" + name, "Share of slides with " + words, "1"});
  }
}

}  // namespace

std::vector<EnsembleMap> slide_maps(const Ensemble& ensemble) {
  std::vector<EnsembleMap> maps;
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) add_largest(maps, tally);
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) add_counts(maps, ensemble, tally);
  return maps;
}

std::vector<double> slide_values(const Ensemble& ensemble, const EnsembleMap& map) {
  std::vector<double> values = kept_values(ensemble, map, {}).values;
  const MapTally& tally = ensemble.counts.maps[map.tally];
  for (std::size_t place = 0; place < values.size(); ++place) {
    const std::uint32_t came = map.kind == Kind::largest ? tally.reached[place] : tally.exceeded[map.threshold][place];
    if (came == 0) values[place] = nan;
  }
  return values;
}

CellWindow reached_cells(const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  const MapGrid& grid = counts.scene.grid;
  int west = grid.columns, south = grid.rows, east = 0, north = 0;
  const std::vector<std::uint32_t>& reached = counts.maps[0].reached;
  for (std::size_t place = 0; place < reached.size(); ++place) {
    if (reached[place] == 0) continue;
    const auto [column, row] = counts.cells.cell(place);
    west = std::min(west, column);
    east = std::max(east, column + 1);
    south = std::min(south, row);
    north = std::max(north, row + 1);
  }
  if (east <= west) return {0, 0, grid.columns, grid.rows};
  const int around = 5 + std::max(east - west, north - south) / 20;
  west = std::max(0, west - around);
  south = std::max(0, south - around);
  return {west, south, std::min(grid.columns, east + around) - west, std::min(grid.rows, north + around) - south};
}

Window reached_part(const Ensemble& ensemble) {
  const MapGrid part = cut(ensemble.counts.scene.grid, reached_cells(ensemble));
  return {part.west, part.south, part.east(), part.north()};
}

Raster coarse_map(const Ensemble& ensemble, const EnsembleMap& map, const std::vector<double>& values,
                  const CellWindow& part, int factor) {
  const EnsembleCounts& counts = ensemble.counts;
  const bool smallest = map.kind == Kind::largest && counted_maps[map.tally].early;
  MapGrid grid = cut(counts.scene.grid, part);
  grid.cell *= factor;
  grid.columns = (part.columns + factor - 1) / factor;
  grid.rows = (part.rows + factor - 1) / factor;
  Raster coarse{grid, std::vector<double>(grid.count(), nan)};
  for (std::size_t place = 0; place < values.size(); ++place) {
    if (std::isnan(values[place])) continue;
    const auto [column, row] = counts.cells.cell(place);
    const int c = column - part.column, r = row - part.row;
    if (c < 0 || r < 0 || c >= part.columns || r >= part.rows) continue;
    double& value = coarse.at(c / factor, r / factor);
    value = smallest ? std::fmin(value, values[place]) : std::fmax(value, values[place]);  // NaN is passed over
  }
  return coarse;
}

SparseValues halved(const SparseValues& fine, const MapGrid& grid, bool smallest) {
  SparseValues coarse{grid, KeptCells(grid), {}};
  for (std::size_t place = 0; place < fine.values.size(); ++place) {
    if (std::isnan(fine.values[place])) continue;
    const auto [column, row] = fine.cells.cell(place);
    const std::size_t to = coarse.cells.keep(column / 2, grid.rows - 1 - (fine.grid.rows - 1 - row) / 2);
    coarse.values.resize(coarse.cells.count(), nan);
    double& value = coarse.values[to];
    value = smallest ? std::fmin(value, fine.values[place]) : std::fmax(value, fine.values[place]);
  }
  return coarse;
}

void each_block(const SparseValues& sparse, const std::function<void(const Raster&)>& take) {
  constexpr int side = KeptCells::side;
  const MapGrid& grid = sparse.grid;
  for (std::size_t first = 0; first < sparse.values.size(); first += KeptCells::of_block) {
    const auto [column, row] = sparse.cells.cell(first);
    const CellWindow window{column, row, std::min(side, grid.columns - column), std::min(side, grid.rows - row)};
    Raster block{cut(grid, window), {}};
    for (int r = 0; r < window.rows; ++r)
      for (int c = 0; c < window.columns; ++c)
        block.values.push_back(sparse.values[first + static_cast<std::size_t>(r * side + c)]);
    take(block);
  }
}

}  // namespace talus::postprocess
