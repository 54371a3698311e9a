// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/tally.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "common/run/sealed_file.hpp"

namespace talus {

KeptCells::KeptCells(const MapGrid& grid)
    : columns_(grid.columns),
      rows_(grid.rows),
      blocks_across_((grid.columns + side - 1) / side),
      slot_of_(static_cast<std::size_t>(blocks_across_) * static_cast<std::size_t>((grid.rows + side - 1) / side), -1) {
}

std::size_t KeptCells::find(int column, int row) const {
  const int block = row / side * blocks_across_ + column / side;
  const std::int32_t slot = slot_of_[static_cast<std::size_t>(block)];
  if (slot < 0) return none;
  return static_cast<std::size_t>(slot) * of_block + static_cast<std::size_t>(row % side * side + column % side);
}

std::size_t KeptCells::keep(int column, int row) {
  return keep_block(row / side * blocks_across_ + column / side) +
         static_cast<std::size_t>(row % side * side + column % side);
}

std::size_t KeptCells::keep_block(std::int32_t block) {
  std::int32_t& slot = slot_of_[static_cast<std::size_t>(block)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(blocks_.size());
    blocks_.push_back(block);
  }
  return static_cast<std::size_t>(slot) * of_block;
}

std::array<int, 2> KeptCells::cell(std::size_t place) const {
  const std::int32_t block = blocks_[place / of_block];
  const int within = static_cast<int>(place % of_block);
  return {block % blocks_across_ * side + within % side, block / blocks_across_ * side + within / side};
}

std::vector<std::size_t> KeptCells::in_order() const {
  std::vector<std::size_t> slots(blocks_.size());
  std::iota(slots.begin(), slots.end(), std::size_t{0});
  std::sort(slots.begin(), slots.end(), [&](std::size_t a, std::size_t b) { return blocks_[a] < blocks_[b]; });
  std::vector<std::size_t> places;
  places.reserve(count());
  for (const std::size_t slot : slots)
    for (std::size_t n = 0; n < of_block; ++n) places.push_back(slot * of_block + n);
  return places;
}

namespace {

/// The largest number of quanta that is counted: its square, summed over a million members, is a 64-bit number.
constexpr std::int64_t most_quanta = 3'000'000;

std::int64_t quanta_of(const CountedMap& map, double value) {
  return std::min(most_quanta, static_cast<std::int64_t>(std::llround(value / map.quantum)));
}

/// The larger of two numbers of quanta, of a time the smaller; -1 is none.
std::int32_t further(const CountedMap& map, std::int32_t a, std::int32_t b) {
  if (a < 0 || b < 0) return std::max(a, b);
  return map.early ? std::min(a, b) : std::max(a, b);
}

std::vector<std::uint32_t> read_counted(const h5::File& file, const std::string& path, std::size_t cells,
                                        std::int64_t most) {
  const h5::Allowed allowed{.low = 0, .high = static_cast<double>(most)};
  const auto values = file.read<std::int32_t>(path, {cells}, allowed);
  return {values.begin(), values.end()};
}

/// Writes values by place in the order of the file, as the numbers that it holds.
template <class Stored, class T>
void write_sorted(h5::File& file, const std::string& path, const std::vector<T>& values,
                  const std::vector<std::size_t>& order) {
  std::vector<Stored> sorted;
  sorted.reserve(order.size());
  for (const std::size_t place : order) sorted.push_back(static_cast<Stored>(values[place]));
  file.write_list<Stored>(path, sorted);
}

void write_histograms(h5::File& file, const std::string& group, const CountedMap& map, const CellHistograms& histograms,
                      const std::vector<std::size_t>& order) {
  const auto edges = bin_edges(map);
  file.write_list<std::int64_t>(group + "/bin_edges", edges);
  std::vector<std::int32_t> cells, bins;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const auto counts = histograms.of(order[n]);
    if (counts.empty()) continue;
    cells.push_back(static_cast<std::int32_t>(n));
    bins.insert(bins.end(), counts.begin(), counts.end());
  }
  file.write_list<std::int32_t>(group + "/histogram_cells", cells);
  file.write<std::int32_t>(group + "/histograms", {cells.size(), histogram_bins}, bins);
}

void read_histograms(const h5::File& file, const std::string& group, const CountedMap& map, MapTally& tally) {
  const auto edges = bin_edges(map);
  const auto written = file.read<std::int64_t>(group + "/bin_edges", {edges.size()});
  if (!std::equal(edges.begin(), edges.end(), written.begin()))
    file.refuse(fmt::format("dataset {}/bin_edges", group), "its bins are not those of this program");
  const h5::Allowed a_cell{.low = 0, .high = static_cast<double>(tally.reached.size()) - 1};
  const auto cells = file.read_list<std::int32_t>(group + "/histogram_cells", a_cell);
  const auto bins = file.read<std::int32_t>(group + "/histograms", {cells.size(), histogram_bins}, h5::not_negative);
  for (std::size_t row = 0; row < cells.size(); ++row)
    for (int bin = 0; bin < histogram_bins; ++bin)
      if (const auto count = bins[row * histogram_bins + static_cast<std::size_t>(bin)]; count > 0)
        tally.histograms.add(static_cast<std::size_t>(cells[row]), bin, static_cast<std::uint32_t>(count));
}

/// Refuses counts of a cell that contradict one another.
void check_tally(const h5::File& file, const std::string& group, const MapTally& tally) {
  for (std::size_t cell = 0; cell < tally.reached.size(); ++cell) {
    if (tally.tallied == Tallied::distribution) {
      std::uint64_t binned = 0;
      for (const std::uint32_t count : tally.histograms.of(cell)) binned += count;
      if (binned != tally.reached[cell])
        file.refuse(fmt::format("{}: {} members reached cell {}, and its histogram holds {}", group,
                                tally.reached[cell], cell, binned),
                    "they are the same members");
    }
    if ((tally.reached[cell] > 0) != (tally.extreme[cell] >= 0))
      file.refuse(fmt::format("{}: {} members reached cell {}, and its largest value is {}", group, tally.reached[cell],
                              cell, tally.extreme[cell]),
                  "a cell that was reached has one, and no other");
    for (const std::vector<std::uint32_t>& exceeded : tally.exceeded)
      if (exceeded[cell] > tally.reached[cell])
        file.refuse(fmt::format("{}: {} members reached cell {}, and {} pass a threshold", group, tally.reached[cell],
                                cell, exceeded[cell]),
                    "who passes it is there");
  }
}

}  // namespace

bool is_there(const CountedMap& map, double value) { return map.early ? value >= 0 : value > 0; }

BinEdges bin_edges(const CountedMap& map) {
  BinEdges edges{};
  edges[0] = map.low;
  double edge = static_cast<double>(map.low);
  for (std::size_t n = 1; n < edges.size(); ++n) {
    edge *= map.ratio;
    edges[n] = std::max(edges[n - 1] + 1, static_cast<std::int64_t>(edge));
  }
  return edges;
}

void CellHistograms::add(std::size_t cell, int bin, std::uint32_t count) {
  if (row_of_[cell] < 0) {
    row_of_[cell] = static_cast<std::int32_t>(counts_.size() / histogram_bins);
    counts_.resize(counts_.size() + histogram_bins, 0);
  }
  counts_[static_cast<std::size_t>(row_of_[cell]) * histogram_bins + static_cast<std::size_t>(bin)] += count;
}

std::span<const std::uint32_t> CellHistograms::of(std::size_t cell) const {
  if (row_of_[cell] < 0) return {};
  return std::span(counts_).subspan(static_cast<std::size_t>(row_of_[cell]) * histogram_bins, histogram_bins);
}

MapTally::MapTally(std::vector<double> of_thresholds, std::size_t cells, Tallied what)
    : thresholds(std::move(of_thresholds)), tallied(what), exceeded(thresholds.size()) {
  grow(cells);
}

void MapTally::grow(std::size_t cells) {
  for (std::vector<std::uint32_t>& counts : exceeded) counts.resize(cells, 0);
  reached.resize(cells, 0);
  extreme.resize(cells, -1);
  if (tallied == Tallied::largest) return;
  sum.resize(cells, 0);
  sum_of_squares.resize(cells, 0);
  histograms.grow(cells);
}

void MapTally::add(const CountedMap& map, const BinEdges& edges, std::size_t cell, double value) {
  if (!is_there(map, value)) return;  // NaN is not
  const std::int64_t quanta = quanta_of(map, value);
  ++reached[cell];
  extreme[cell] = further(map, extreme[cell], static_cast<std::int32_t>(quanta));
  for (std::size_t n = 0; n < thresholds.size(); ++n)
    if (map.early ? value <= thresholds[n] : value >= thresholds[n]) ++exceeded[n][cell];
  if (tallied == Tallied::largest) return;
  sum[cell] += quanta;
  sum_of_squares[cell] += quanta * quanta;
  histograms.add(cell, static_cast<int>(std::upper_bound(edges.begin(), edges.end(), quanta) - edges.begin()));
}

void MapTally::add(const CountedMap& map, const MapTally& other, std::span<const std::size_t> places) {
  if (other.thresholds != thresholds || other.tallied != tallied || places.size() != other.reached.size())
    throw std::logic_error("MapTally: counts of another grid or of other thresholds");
  for (std::size_t from = 0; from < places.size(); ++from) {
    if (other.reached[from] == 0) continue;
    const std::size_t cell = places[from];
    for (std::size_t n = 0; n < thresholds.size(); ++n) exceeded[n][cell] += other.exceeded[n][from];
    reached[cell] += other.reached[from];
    extreme[cell] = further(map, extreme[cell], other.extreme[from]);
    if (tallied == Tallied::largest) continue;
    sum[cell] += other.sum[from];
    sum_of_squares[cell] += other.sum_of_squares[from];
    const auto counts = other.histograms.of(from);
    for (std::size_t bin = 0; bin < counts.size(); ++bin)
      if (counts[bin] > 0) histograms.add(cell, static_cast<int>(bin), counts[bin]);
  }
}

double MapTally::largest(const CountedMap& map, std::size_t cell) const {
  if (extreme[cell] < 0) return map.early ? nan : 0;
  return map.quantum * extreme[cell];
}

double MapTally::mean(const CountedMap& map, std::size_t cell, std::int64_t members) const {
  const auto of = static_cast<double>(map.early ? reached[cell] : members);
  return of > 0 ? map.quantum * static_cast<double>(sum[cell]) / of : nan;
}

double MapTally::deviation(const CountedMap& map, std::size_t cell, std::int64_t members) const {
  const auto of = static_cast<double>(map.early ? reached[cell] : members);
  if (!(of > 0)) return nan;
  const double mean = static_cast<double>(sum[cell]) / of;
  return map.quantum * std::sqrt(std::max(0.0, static_cast<double>(sum_of_squares[cell]) / of - mean * mean));
}

double MapTally::quantile(const CountedMap& map, std::size_t cell, double share, std::int64_t members) const {
  const double absent = static_cast<double>(members) - reached[cell];
  double wanted = share * static_cast<double>(members) - (map.early ? 0 : absent);
  if (!(wanted > 0)) return map.early ? nan : 0;
  if (map.early && wanted > reached[cell]) return nan;
  const auto edges = bin_edges(map);
  const auto counts = histograms.of(cell);
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const double count = counts[bin];
    if (count < wanted) {
      wanted -= count;
      continue;
    }
    const double from = bin == 0 ? 0 : static_cast<double>(edges[bin - 1]);
    const double to = bin < edges.size() ? static_cast<double>(edges[bin]) : from * map.ratio;
    return map.quantum * (from + (to - from) * wanted / count);
  }
  return map.quantum * static_cast<double>(edges.back()) * map.ratio;
}

void write_tally(h5::File& file, const CountedMap& map, const MapTally& tally, const std::vector<std::size_t>& order) {
  const auto group = std::string("/maps/") + map.name;
  file.make_group(group);
  file.set_text(group, "unit", map.unit);
  file.set_number(group, "quantum", map.quantum);
  file.write_list<double>(group + "/thresholds", tally.thresholds);
  file.make_group(group + "/exceeded");
  for (std::size_t n = 0; n < tally.thresholds.size(); ++n)
    write_sorted<std::int32_t>(file, fmt::format("{}/exceeded/{:03}", group, n), tally.exceeded[n], order);
  write_sorted<std::int32_t>(file, group + "/reached", tally.reached, order);
  write_sorted<std::int32_t>(file, group + "/extreme", tally.extreme, order);
  if (tally.tallied == Tallied::largest) return;
  write_sorted<std::int64_t>(file, group + "/sum", tally.sum, order);
  write_sorted<std::int64_t>(file, group + "/sum_of_squares", tally.sum_of_squares, order);
  write_histograms(file, group, map, tally.histograms, order);
}

MapTally read_tally(const h5::File& file, const CountedMap& map, const TallyShape& shape) {
  const auto group = std::string("/maps/") + map.name;
  const std::size_t cells = shape.cells;
  MapTally tally(file.read_list<double>(group + "/thresholds"), cells, shape.tallied);
  h5::check_growing(file, group + "/thresholds", tally.thresholds, h5::finite);
  for (std::size_t n = 0; n < tally.thresholds.size(); ++n)
    tally.exceeded[n] = read_counted(file, fmt::format("{}/exceeded/{:03}", group, n), cells, shape.members);
  tally.reached = read_counted(file, group + "/reached", cells, shape.members);
  tally.extreme = file.read<std::int32_t>(group + "/extreme", {cells}, {.low = -1});
  if (tally.tallied == Tallied::distribution) {
    tally.sum = file.read<std::int64_t>(group + "/sum", {cells}, h5::not_negative);
    tally.sum_of_squares = file.read<std::int64_t>(group + "/sum_of_squares", {cells}, h5::not_negative);
    read_histograms(file, group, map, tally);
  }
  check_tally(file, group, tally);
  return tally;
}

std::vector<std::size_t> write_cells(h5::File& file, const KeptCells& cells) {
  std::vector<std::int32_t> blocks = cells.blocks();
  std::sort(blocks.begin(), blocks.end());
  file.make_group("/cells");
  file.set_integer("/cells", "block_side", KeptCells::side);
  file.write_list<std::int32_t>("/cells/blocks", blocks);
  return cells.in_order();
}

KeptCells read_cells(const h5::File& file, const MapGrid& grid) {
  constexpr double most = 1e11;  // cells of a grid: the list of its blocks is 1.6 GB
  if (static_cast<double>(grid.columns) * grid.rows > most)
    file.refuse(fmt::format("has a map of {} x {} cells", grid.columns, grid.rows), "no model is so large");
  KeptCells cells(grid);
  const h5::Allowed a_block{.low = 0, .high = static_cast<double>(cells.all_blocks()) - 1};
  const auto blocks = file.read_list<std::int32_t>("/cells/blocks", a_block);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    if (n > 0 && blocks[n] <= blocks[n - 1])
      file.refuse(fmt::format("dataset /cells/blocks holds {} behind {}", blocks[n], blocks[n - 1]),
                  "blocks stand in their order");
    cells.keep_block(blocks[n]);
  }
  return cells;
}

}  // namespace talus
