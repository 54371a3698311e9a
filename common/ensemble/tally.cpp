// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/tally.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace talus {
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

std::vector<std::int32_t> CellHistograms::cells() const {
  std::vector<std::int32_t> cells;
  for (std::size_t cell = 0; cell < row_of_.size(); ++cell)
    if (row_of_[cell] >= 0) cells.push_back(static_cast<std::int32_t>(cell));
  return cells;
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

void MapTally::add(const CountedMap& map, std::span<const double> values) {
  if (values.size() != reached.size()) throw std::logic_error("MapTally: a map of another grid");
  const BinEdges edges = bin_edges(map);
  for (std::size_t cell = 0; cell < values.size(); ++cell) add(map, edges, cell, values[cell]);
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

void MapTally::add(const CountedMap& map, const MapTally& other) {
  if (other.reached.size() != reached.size())
    throw std::logic_error("MapTally: counts of another grid or of other thresholds");
  std::vector<std::size_t> same(reached.size());
  std::iota(same.begin(), same.end(), std::size_t{0});
  add(map, other, same);
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

}  // namespace talus
