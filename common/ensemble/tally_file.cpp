// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/tally_file.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "common/run/check_values.hpp"

namespace talus {
namespace {

template <class T>
h5::Dims shape_of(const std::vector<T>& list) {
  return {static_cast<hsize_t>(list.size())};
}

/// Values by place in the order of a file, as the numbers that it holds.
template <class Stored, class T>
std::vector<Stored> in_file(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<Stored> sorted;
  sorted.reserve(order.size());
  for (const std::size_t place : order) sorted.push_back(static_cast<Stored>(values[place]));
  return sorted;
}

std::vector<std::uint32_t> read_counted(const h5::File& file, const std::string& path, std::size_t cells,
                                        std::int64_t most) {
  const auto values = file.read<std::int32_t>(path, {static_cast<hsize_t>(cells)});
  h5::check_values<std::int32_t>(file, path, values,
                                 {.low = 0, .high = static_cast<double>(most), .why = "there are not so many members"});
  return {values.begin(), values.end()};
}

template <class Stored, class T>
void write_sorted(h5::File& file, const std::string& path, const std::vector<T>& values,
                  const std::vector<std::size_t>& order) {
  file.write<Stored>(path, {order.size()}, in_file<Stored>(values, order));
}

void write_histograms(h5::File& file, const std::string& group, const CountedMap& map, const CellHistograms& histograms,
                      const std::vector<std::size_t>& order) {
  const auto edges = bin_edges(map);
  file.write<std::int64_t>(group + "/bin_edges", {edges.size()}, std::span<const std::int64_t>(edges));
  std::vector<std::int32_t> cells, bins;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const auto counts = histograms.of(order[n]);
    if (counts.empty()) continue;
    cells.push_back(static_cast<std::int32_t>(n));
    bins.insert(bins.end(), counts.begin(), counts.end());
  }
  file.write<std::int32_t>(group + "/histogram_cells", shape_of(cells), cells);
  file.write<std::int32_t>(group + "/histograms", {cells.size(), histogram_bins}, bins);
}

void read_histograms(const h5::File& file, const std::string& group, const CountedMap& map, MapTally& tally) {
  const auto edges = bin_edges(map);
  const auto written = file.read<std::int64_t>(group + "/bin_edges", {edges.size()});
  if (!std::equal(edges.begin(), edges.end(), written.begin()))
    file.refuse(fmt::format("dataset {}/bin_edges", group), "its bins are not those of this program");
  const auto cells = file.read_list<std::int32_t>(group + "/histogram_cells");
  h5::check_values<std::int32_t>(
      file, group + "/histogram_cells", cells,
      {.low = 0, .high = static_cast<double>(tally.reached.size()) - 1, .why = "there is no such cell"});
  const auto bins = file.read<std::int32_t>(group + "/histograms", {cells.size(), histogram_bins});
  h5::check_values<std::int32_t>(file, group + "/histograms", bins, h5::not_negative);
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

void write_tally(h5::File& file, const CountedMap& map, const MapTally& tally, const std::vector<std::size_t>& order) {
  const auto group = std::string("/maps/") + map.name;
  file.make_group(group);
  file.set_text(group, "unit", map.unit);
  file.set_number(group, "quantum", map.quantum);
  file.write<double>(group + "/thresholds", shape_of(tally.thresholds), tally.thresholds);
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
  h5::check_growing(file, group + "/thresholds", tally.thresholds, true);
  for (std::size_t n = 0; n < tally.thresholds.size(); ++n)
    tally.exceeded[n] = read_counted(file, fmt::format("{}/exceeded/{:03}", group, n), cells, shape.members);
  tally.reached = read_counted(file, group + "/reached", cells, shape.members);
  tally.extreme = file.read<std::int32_t>(group + "/extreme", {static_cast<hsize_t>(cells)});
  h5::check_values<std::int32_t>(file, group + "/extreme", tally.extreme, {.low = -1, .why = "-1 stands for none"});
  if (tally.tallied == Tallied::distribution) {
    tally.sum = file.read<std::int64_t>(group + "/sum", {static_cast<hsize_t>(cells)});
    h5::check_values<std::int64_t>(file, group + "/sum", tally.sum, h5::not_negative);
    tally.sum_of_squares = file.read<std::int64_t>(group + "/sum_of_squares", {static_cast<hsize_t>(cells)});
    h5::check_values<std::int64_t>(file, group + "/sum_of_squares", tally.sum_of_squares, h5::not_negative);
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
  file.write<std::int32_t>("/cells/blocks", shape_of(blocks), blocks);
  return cells.in_order();
}

KeptCells read_cells(const h5::File& file, const MapGrid& grid) {
  constexpr double most = 1e11;  // cells of a grid: the list of its blocks is 1.6 GB
  if (static_cast<double>(grid.columns) * grid.rows > most)
    file.refuse(fmt::format("has a map of {} x {} cells", grid.columns, grid.rows), "no model is so large");
  KeptCells cells(grid);
  const auto blocks = file.read_list<std::int32_t>("/cells/blocks");
  h5::check_values<std::int32_t>(
      file, "/cells/blocks", blocks,
      {.low = 0, .high = static_cast<double>(cells.all_blocks()) - 1, .why = "there is no such block"});
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    if (n > 0 && blocks[n] <= blocks[n - 1])
      file.refuse(fmt::format("dataset /cells/blocks holds {} behind {}", blocks[n], blocks[n - 1]),
                  "blocks stand in their order");
    cells.keep_block(blocks[n]);
  }
  return cells;
}

}  // namespace talus
