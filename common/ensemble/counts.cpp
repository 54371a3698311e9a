// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/counts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/map/raster.hpp"

namespace talus {

Footprint footprint_of(std::span<const double> thickness, double threshold) {
  Footprint runs{0};
  bool inside = false;
  for (const double h : thickness) {
    if ((h > threshold) != inside) {
      inside = !inside;
      runs.push_back(0);
    }
    ++runs.back();
  }
  return runs;
}

std::vector<std::uint8_t> cells_of(const Footprint& footprint, std::size_t cells) {
  std::vector<std::uint8_t> inside;
  inside.reserve(cells);
  std::uint8_t value = 0;
  for (const std::int32_t length : footprint) {
    inside.insert(inside.end(), static_cast<std::size_t>(length), value);
    value = value == 0 ? 1 : 0;
  }
  inside.resize(cells, 0);
  return inside;
}

std::size_t covered_cells(const Footprint& footprint) {
  std::size_t covered = 0;
  for (std::size_t run = 1; run < footprint.size(); run += 2) covered += static_cast<std::size_t>(footprint[run]);
  return covered;
}

KeptThickness keep_thickness(std::span<const double> thickness, double quantum) {
  KeptThickness kept{footprint_of(thickness, 0), {}, quantum};
  kept.values.reserve(covered_cells(kept.cells));
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  for (const double h : thickness)
    if (h > 0) kept.values.push_back(static_cast<std::int32_t>(std::lround(std::min(h / quantum, most))));
  return kept;
}

std::vector<double> KeptThickness::thickness(std::size_t count) const {
  const std::vector<std::uint8_t> inside = cells_of(cells, count);
  std::vector<double> map(count, 0.0);
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < count; ++cell)
    if (inside[cell] != 0) map[cell] = quantum * values[next++];
  return map;
}

namespace {

const std::vector<double>& thresholds_of(const CountedMap& map, const ThresholdOptions& o) {
  const std::string_view name = map.name;
  if (name == "peak_thickness") return o.thickness;
  if (name == "deposit_thickness") return o.deposit;
  if (name == "peak_speed") return o.speed;
  return name == "peak_pressure" ? o.pressure : o.arrival;
}

constexpr std::vector<Footprint> EnsembleCounts::*footprints_of_members[] = {
    &EnsembleCounts::release, &EnsembleCounts::flow, &EnsembleCounts::deposit};

/// This function moves the members of `part` into `all`, whose range holds theirs.
void take(EnsembleCounts& all, EnsembleCounts&& part) {
  std::vector<std::size_t> places(part.cells.count());
  for (std::size_t place = 0; place < places.size(); place += KeptCells::of_block) {
    const std::size_t first = all.cells.keep_block(part.cells.blocks()[place / KeptCells::of_block]);
    for (std::size_t n = 0; n < KeptCells::of_block; ++n) places[place + n] = first + n;
  }
  for (std::size_t m = 0; m < all.maps.size(); ++m) {
    all.maps[m].grow(all.cells.count());
    all.maps[m].add(counted_maps[m], part.maps[m], places);
  }
  for (std::int64_t k = part.part.first; k < part.part.end; ++k) {
    const std::size_t from = part.place_of(k), to = all.place_of(k);
    if (part.states[from] == MemberState::waiting) continue;
    all.states[to] = part.states[from];
    all.results[to] = part.results[from];
    all.windows[to] = part.windows[from];
    for (auto footprints : footprints_of_members) (all.*footprints)[to] = std::move((part.*footprints)[from]);
    all.deposit_thickness[to] = std::move(part.deposit_thickness[from]);
  }
  all.grids.merge(part.grids);
  for (auto list : {&EnsembleCounts::failures, &EnsembleCounts::changes})
    for (MemberWords& one : part.*list) add_in_order(all.*list, std::move(one));
  for (Finding& finding : part.findings)
    if (const std::int64_t member = finding.member; member != Finding::no_member)
      all.add_finding(member, std::move(finding));
}

bool same_scene(const EnsembleScene& a, const EnsembleScene& b) {
  return a.grid.has_cells_of(b.grid) && a.threshold == b.threshold && a.tallied == b.tallied;
}

/// A cell to which something of a run came: among those of its maps, and its place among those that are kept.
struct CameTo {
  std::size_t of_run = 0, place = 0;
};

std::vector<CameTo> keep_what_came(const RunMaps& run, const CellWindow& window, KeptCells& cells) {
  std::vector<CameTo> found;
  for (int row = 0; row < window.rows; ++row)
    for (int column = 0; column < window.columns; ++column) {
      const std::size_t cell = run.grid.index(column, row);
      const bool came = std::any_of(std::begin(counted_maps), std::end(counted_maps),
                                    [&](const CountedMap& map) { return is_there(map, (run.*(map.values))[cell]); });
      if (came) found.push_back({cell, cells.keep(window.column + column, window.row + row)});
    }
  return found;
}

/// Values at the centres of another grid's cells; 0 beyond their own.
std::vector<double> at_centres(const MapGrid& from, const std::vector<double>& values, const MapGrid& to) {
  std::vector<double> found(to.count(), 0.0);
  for (int row = 0; row < to.rows; ++row)
    for (int column = 0; column < to.columns; ++column) {
      const double across = std::floor((to.x(column) - from.west) / from.cell),
                   up = std::floor((to.y(row) - from.south) / from.cell);
      if (across >= 0 && up >= 0 && across < from.columns && up < from.rows)
        found[to.index(column, row)] = values[from.index(static_cast<int>(across), static_cast<int>(up))];
    }
  return found;
}

/// Refuses a part that cannot be added to the others.
void require_alike(const EnsembleCounts& all, const EnsembleCounts& part, const std::filesystem::path& file,
                   const std::filesystem::path& first) {
  bool thresholds = true;
  for (std::size_t m = 0; m < all.maps.size(); ++m)
    thresholds = thresholds && all.maps[m].thresholds == part.maps[m].thresholds;
  const char* why = part.fingerprint != all.fingerprint  ? "members, domain or settings differ"
                    : part.members != all.members        ? "the number of members differs"
                    : !same_scene(all.scene, part.scene) ? "grid or threshold of the footprints differ"
                    : !thresholds                        ? "the thresholds of the maps differ"
                                                         : nullptr;
  if (why != nullptr)
    throw DataError({file.string() + ": counts of another ensemble than " + first.string(), why,
                     "Remove what does not belong here, or run it again"});
}

/// The first member that both have done, or none.
std::int64_t shared_member(const EnsembleCounts& all, const EnsembleCounts& part) {
  for (std::int64_t k = part.part.first; k < part.part.end; ++k)
    if (part.state_of(k) != MemberState::waiting && all.state_of(k) != MemberState::waiting) return k;
  return -1;
}

}  // namespace

std::int64_t EnsembleCounts::count(MemberState state) const { return std::count(states.begin(), states.end(), state); }

std::vector<std::int64_t> EnsembleCounts::at_edge() const {
  std::vector<std::int64_t> found;
  for (std::size_t k = 0; k < states.size(); ++k)
    if (states[k] == MemberState::counted && is_at_edge(results[k]))
      found.push_back(part.first + static_cast<std::int64_t>(k));
  return found;
}

MapGrid EnsembleCounts::grid_of(std::int64_t member) const {
  const auto other = grids.find(member);
  return other != grids.end() ? other->second : cut(scene.grid, windows.at(place_of(member)));
}

void EnsembleCounts::add(std::int64_t member, const RunMaps& run, const MemberResult& result) {
  const std::size_t place = place_of(member);
  const auto window = window_on(scene.grid, run.grid);
  if (!window && !other_cells) throw std::logic_error("EnsembleCounts: a member's grid is no window of the scene's");
  if (window)
    tally(run, *window);
  else
    grids[member] = run.grid;
  states.at(place) = MemberState::counted;
  results[place] = result;
  windows[place] = window.value_or(CellWindow{0, 0, scene.grid.columns, scene.grid.rows});
  const auto footprint = [&](const std::vector<double>& values, double threshold) {
    return footprint_of(window ? values : at_centres(run.grid, values, scene.grid), threshold);
  };
  release[place] = footprint(run.initial_thickness, 0);
  flow[place] = footprint(run.peak_thickness, scene.threshold);
  deposit[place] = footprint(run.deposit_thickness, scene.threshold);
  if (deposit_quantum > 0) deposit_thickness[place] = keep_thickness(run.deposit_thickness, deposit_quantum);
}

void EnsembleCounts::tally(const RunMaps& run, const CellWindow& window) {
  const std::vector<CameTo> cells_reached = keep_what_came(run, window, cells);
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const std::vector<double>& values = run.*(counted_maps[m].values);
    const BinEdges edges = bin_edges(counted_maps[m]);
    maps[m].grow(cells.count());
    for (const CameTo& cell : cells_reached) maps[m].add(counted_maps[m], edges, cell.place, values[cell.of_run]);
  }
}

void EnsembleCounts::add_finding(std::int64_t member, Finding finding) {
  finding.member = member;
  findings.insert(std::ranges::upper_bound(findings, member, {}, &Finding::member), std::move(finding));
}

void EnsembleCounts::fail(std::int64_t member, std::string words) {
  states.at(place_of(member)) = MemberState::failed;
  add_in_order(failures, {member, std::move(words)});
}

void EnsembleCounts::leave_out(std::int64_t member, std::string words) {
  states.at(place_of(member)) = MemberState::left_out;
  if (!words.empty()) add_in_order(failures, {member, std::move(words)});
}

const char* unit_at_gauge(const std::string& name) {
  const auto* const of = std::ranges::find_if(
      gauge_numbers, [&](const GaugeNumber& number) { return name.ends_with(std::string("_") + number.name); });
  return of == std::end(gauge_numbers) ? "1" : of->unit;
}

std::map<std::string, std::vector<double>> EnsembleCounts::at_gauges() const {
  std::map<std::string, std::vector<double>> numbers;
  for (std::size_t k = 0; k < results.size(); ++k)
    for (const auto& [name, value] : results[k].at_gauges)
      numbers.try_emplace(name, results.size(), nan).first->second[k] = value;
  return numbers;
}

bool is_at_edge(const MemberResult& result) { return result.edge_cells > 0 || result.volume_outflow > 0; }

std::optional<CellWindow> window_on(const MapGrid& all, const MapGrid& part) {
  if (!same_lattice(all, part)) return std::nullopt;
  const CellWindow window{static_cast<int>(std::lround((part.west - all.west) / all.cell)),
                          static_cast<int>(std::lround((part.south - all.south) / all.cell)), part.columns, part.rows};
  return lies_in(window, all) ? std::optional(window) : std::nullopt;
}

EnsembleCounts empty_counts(EnsembleScene scene, std::int64_t members, const MemberRange& part,
                            const ThresholdOptions& thresholds) {
  EnsembleCounts counts;
  counts.members = members;
  counts.part = part;
  for (std::size_t m = 0; m < counts.maps.size(); ++m)
    counts.maps[m] = MapTally(thresholds_of(counted_maps[m], thresholds), 0, scene.tallied);
  counts.cells = KeptCells(scene.grid);
  counts.scene = std::move(scene);
  const auto count = static_cast<std::size_t>(part.count());
  counts.states.assign(count, MemberState::waiting);
  counts.results.resize(count);
  counts.windows.resize(count);
  for (auto footprints : footprints_of_members) (counts.*footprints).resize(count);
  counts.deposit_thickness.resize(count);
  return counts;
}

EnsembleCounts merged(std::vector<EnsembleCounts> parts, const std::vector<std::filesystem::path>& files) {
  EnsembleCounts all;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    EnsembleCounts& part = parts[n];
    if (n == 0) {
      all = empty_counts(part.scene, part.members, {0, part.members}, {});
      all.fingerprint = part.fingerprint;
      all.provenance = part.provenance;
      std::ranges::copy_if(part.findings, std::back_inserter(all.findings),
                           [](const Finding& f) { return f.member == Finding::no_member; });
      for (std::size_t m = 0; m < all.maps.size(); ++m)
        all.maps[m] = MapTally(part.maps[m].thresholds, 0, part.scene.tallied);
    }
    require_alike(all, part, files[n], files[0]);
    if (const std::int64_t twice = shared_member(all, part); twice >= 0)
      throw DataError({fmt::format("{}: member {} is counted in another file as well", files[n].string(), twice),
                       "it would count twice", "Remove one of the files of counts"});
    take(all, std::move(part));
  }
  return all;
}

}  // namespace talus
