// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// counts.h5: what talus-solve hands to talus-postprocess of an ensemble or of a part of one; footprints of members.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/ensemble/tally.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"

namespace talus {

/// Lengths of runs of cells over the flat grid, the first outside, the second inside, and so on.
using Footprint = std::vector<std::int32_t>;

/// The footprint of what is thicker than `threshold` [m].
Footprint footprint_of(std::span<const double> thickness, double threshold);

/// 1 inside, 0 outside; `cells`: the number of cells of the grid.
std::vector<std::uint8_t> cells_of(const Footprint& footprint, std::size_t cells);

/// The number of cells inside.
std::size_t covered_cells(const Footprint& footprint);

/// Thickness of the cells where there is any, in whole multiples of a quantum.
struct KeptThickness {
  Footprint cells;                   ///< that are thicker than 0; empty: nothing is kept
  std::vector<std::int32_t> values;  ///< of those cells, in their order [quanta]
  double quantum = 0;                ///< [m]

  bool kept() const { return !cells.empty(); }  ///< whether a map is kept, be it of nothing
  /// The map, 0 where there is nothing [m]; `count`: its number of cells.
  std::vector<double> thickness(std::size_t count) const;
};

/// Keeps a map of thickness in multiples of `quantum` [m]; NaN is nothing.
KeptThickness keep_thickness(std::span<const double> thickness, double quantum);

/// The numbers of one member's run, as result_numbers explains them; NaN where there is none.
struct MemberResult {
  double run_out = nan, drop = nan, reach_ratio = nan, flow_reach = nan, centre_travel = nan;
  double flow_area = nan, deposit_area = nan;
  double volume_released = nan, volume_final = nan, volume_outflow = nan;
  double largest_thickness = nan, largest_deposit = nan, largest_speed = nan, largest_pressure = nan;
  double p99_thickness = nan, p99_deposit = nan, p99_speed = nan, p99_pressure = nan;
  double time_end = nan, steps = nan, wall_time = nan, edge_cells = nan;
  std::map<std::string, double> at_gauges = {};  ///< by "gauge_NAME_" and the name of a GaugeNumber
};

/// A number of a member at a gauge: what a map holds in its cell.
struct GaugeNumber {
  const char* name;  ///< with its unit: "arrival_s"
  const char* unit;
  MapMember values;
};
inline constexpr GaugeNumber gauge_numbers[] = {
    {"arrival_s", "s", &RunMaps::arrival_time},
    {"peak_thickness_m", "m", &RunMaps::peak_thickness},
    {"peak_speed_m_s", "m s-1", &RunMaps::peak_speed},
    {"peak_pressure_kPa", "kPa", &RunMaps::peak_pressure_kPa},
};

/// The unit of a number of MemberResult::at_gauges.
const char* unit_at_gauge(const std::string& name);

/// A number of MemberResult, wherever it goes.
struct ResultNumber {
  const char* name;  ///< with its unit: "run_out_m"
  const char* unit;  ///< in UDUNITS' words
  const char* meaning;
  double MemberResult::*value;
};

/// All of them, in the order of tables.
inline constexpr ResultNumber result_numbers[] = {
    {"run_out_m", "m", "run-out: plan distance from the crown to the deposit's farthest cell", &MemberResult::run_out},
    {"drop_m", "m", "height of the crown over that cell", &MemberResult::drop},
    {"reach_ratio", "1", "drop over run-out (H/L)", &MemberResult::reach_ratio},
    {"flow_reach_m", "m", "plan distance from the crown to the farthest cell ever covered", &MemberResult::flow_reach},
    {"centre_travel_m", "m", "plan way of the centre of mass, from the release to the deposit",
     &MemberResult::centre_travel},
    {"flow_area_m2", "m2", "area that was ever thicker than the threshold", &MemberResult::flow_area},
    {"deposit_area_m2", "m2", "area thicker than the threshold at the end", &MemberResult::deposit_area},
    {"volume_released_m3", "m3", "released volume", &MemberResult::volume_released},
    {"volume_final_m3", "m3", "volume in the domain at the end", &MemberResult::volume_final},
    {"volume_outflow_m3", "m3", "volume that left the domain", &MemberResult::volume_outflow},
    {"largest_thickness_m", "m", "largest thickness anywhere and at any time", &MemberResult::largest_thickness},
    {"p99_thickness_m", "m", "99 % of the cells with a largest thickness above 0 are below",
     &MemberResult::p99_thickness},
    {"largest_deposit_m", "m", "largest thickness of the deposit", &MemberResult::largest_deposit},
    {"p99_deposit_m", "m", "99 % of the cells with a deposit are below", &MemberResult::p99_deposit},
    {"largest_speed_m_s", "m s-1", "largest speed anywhere and at any time", &MemberResult::largest_speed},
    {"p99_speed_m_s", "m s-1", "99 % of the cells with a largest speed above 0 are below", &MemberResult::p99_speed},
    {"largest_pressure_kPa", "kPa", "largest pressure anywhere and at any time", &MemberResult::largest_pressure},
    {"p99_pressure_kPa", "kPa", "99 % of the cells with a largest pressure above 0 are below",
     &MemberResult::p99_pressure},
    {"time_end_s", "s", "simulated time", &MemberResult::time_end},
    {"steps", "1", "time steps", &MemberResult::steps},
    {"wall_time_s", "s", "wall time of the steps", &MemberResult::wall_time},
    {"edge_cells", "1", "cells at the edge of the member's grid to which something came", &MemberResult::edge_cells},
};

enum class MemberState : std::uint8_t { waiting = 0, counted = 1, failed = 2, left_out = 3 };

/// The scene of an ensemble, for maps and pages.
struct EnsembleScene {
  std::string scene, title;
  MapGrid grid;                           ///< the members' own, or one that holds the windows of all
  std::vector<double> terrain;            ///< bed of the base domain [m], [rows * columns]; empty where members have
                                          ///< windows of their own
  std::vector<double> before;             ///< surface before the failure [m], likewise
  std::vector<double> release_thickness;  ///< of the base domain [m], likewise
  double threshold = 0;                   ///< thickness from which a cell counts as covered [m]
  Tallied tallied = Tallied::distribution;
};

/// Counts, results and footprints of the members of a part.
struct EnsembleCounts {
  std::string fingerprint;   ///< of members, domain and settings: counts of other fingerprints are of another ensemble
  std::int64_t members = 0;  ///< of the whole ensemble
  MemberRange part;          ///< whose members the lists below are of
  EnsembleScene scene;
  KeptCells cells;                               ///< in which members came anywhere
  std::array<MapTally, counted_map_count> maps;  ///< by counted_maps, [places of the cells]
  std::vector<MemberState> states;               ///< [part.count()]
  std::vector<MemberResult> results;             ///< likewise
  std::vector<CellWindow> windows;  ///< likewise: the member's grid among the scene's; empty unless counted
  std::vector<Footprint> release, flow, deposit;  ///< likewise, over the cells of the window; empty unless counted
  std::vector<KeptThickness> deposit_thickness;   ///< likewise; of members that were added with a deposit_quantum
  double deposit_quantum = 0;                     ///< members that are added leave the map of their deposit in
                                                  ///< multiples of this [m]; 0: they leave none
  bool other_cells = false;                       ///< members may have other cells than the scene's
  std::map<std::int64_t, MapGrid> grids;  ///< theirs, on which their deposit is kept; maps count nothing of them
                                          ///< and their footprints are on the scene's cells
  std::vector<MemberWords> failures;      ///< of members that failed or are left out, by member
  std::vector<MemberWords> changes;       ///< of a budget: what is other, then the keys that make it by hand
  Facts provenance;
  std::vector<Finding> findings;  ///< of the stages, then of members that ended, by member

  /// Where a member of the part stands in the lists.
  std::size_t place_of(std::int64_t member) const { return static_cast<std::size_t>(member - part.first); }
  MemberState state_of(std::int64_t member) const { return states.at(place_of(member)); }
  std::int64_t count(MemberState state) const;  ///< the number of members of a state
  /// Each number that members measured at gauges, by its name [part.count()]; NaN where a member has none.
  std::map<std::string, std::vector<double>> at_gauges() const;
  /// Numbers of counted members that came to the edge of their grid, or left it.
  std::vector<std::int64_t> at_edge() const;
  MapGrid grid_of(std::int64_t member) const;  ///< the grid on which a counted member's deposit is kept
  /// Counts a member's run. Throws std::logic_error where its grid is no window of the scene's and must be one.
  void add(std::int64_t member, const RunMaps& maps, const MemberResult& result);
  void add_finding(std::int64_t member, Finding finding);  ///< notes what a member found
  void fail(std::int64_t member, std::string words);       ///< notes that a member failed
  /// The method notes that a member is not to be run, and why; empty words: it has nothing to change.
  void leave_out(std::int64_t member, std::string words);

 private:
  void tally(const RunMaps& run, const CellWindow& window);
};

/// Whether a member came to the edge of its grid: what lies beyond is not known.
bool is_at_edge(const MemberResult& result);

/// The window of a grid among the cells of a larger one; none where its cells are not among them.
std::optional<CellWindow> window_on(const MapGrid& all, const MapGrid& part);

/// Counts of a part in which nothing is counted yet.
EnsembleCounts empty_counts(EnsembleScene scene, std::int64_t members, const MemberRange& part,
                            const ThresholdOptions& thresholds);

/// The counts of all members of parts of one ensemble; members of no part are waiting. Throws DataError: parts of
/// different ensembles, or that share a member. `files` name them in messages.
EnsembleCounts merged(std::vector<EnsembleCounts> parts, const std::vector<std::filesystem::path>& files);

/// Writes counts, sealed and aside. Throws DataError.
void write_counts(const std::filesystem::path& file, const EnsembleCounts& counts);

/// Reads them back. Throws DataError: missing, damaged, no counts, or holding what cannot be.
EnsembleCounts read_counts(const std::filesystem::path& file);

/// Their provenance alone. Throws DataError likewise.
Facts counts_facts(const std::filesystem::path& file);

}  // namespace talus
