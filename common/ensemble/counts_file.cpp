// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Writing and reading counts.h5. Layout: attributes of / = whose counts they are; /scene = grid and ground; /cells =
// which cells are counted; /maps/NAME = counts of a map; /members = states, results, windows and footprints; /failures,
// /provenance, /findings.
#include <algorithm>
#include <charconv>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/tally.hpp"
#include "common/map/raster.hpp"
#include "common/run/sealed_file.hpp"

namespace talus {
namespace {

constexpr h5::Format counts_format{"talus counts", "counts of an ensemble"};

h5::File open_counts(const std::filesystem::path& path) {
  return h5::open_sealed(path, {path, "Run talus-solve again"}, counts_format);
}

void write_footprints(h5::File& file, const std::string& group, const std::vector<Footprint>& footprints) {
  std::vector<std::int64_t> ends;
  Footprint all;
  for (const Footprint& one : footprints) {
    all.insert(all.end(), one.begin(), one.end());
    ends.push_back(static_cast<std::int64_t>(all.size()));
  }
  file.make_group(group);
  file.write_list<std::int64_t>(group + "/ends", ends);
  file.write_list<std::int32_t>(group + "/runs", all);
}

std::vector<Footprint> read_footprints(const h5::File& file, const std::string& group,
                                       const std::vector<std::int64_t>& cells) {
  const std::size_t count = cells.size();
  const auto ends = file.read<std::int64_t>(group + "/ends", {count});
  const auto runs = file.read_list<std::int32_t>(group + "/runs", h5::not_negative);
  std::vector<Footprint> footprints(count);
  std::int64_t begin = 0;
  for (std::size_t k = 0; k < count; begin = ends[k++]) {
    if (ends[k] < begin || ends[k] > static_cast<std::int64_t>(runs.size()))
      file.refuse(fmt::format("dataset {}/ends holds {} at place {}", group, ends[k], k), "no footprint ends there");
    footprints[k].assign(runs.begin() + begin, runs.begin() + ends[k]);
    std::int64_t covered = 0;
    for (const std::int32_t length : footprints[k]) covered += length;
    if (!footprints[k].empty() && covered != cells[k])
      file.refuse(fmt::format("the footprint of place {} in {} is of {} cells", k, group, covered),
                  fmt::format("its grid has {}", cells[k]));
  }
  return footprints;
}

constexpr const char* thickness_group = "/members/deposit_thickness";

/// Those of members that keep none are empty.
void write_thickness(h5::File& file, const std::vector<KeptThickness>& members) {
  const auto first = std::ranges::find_if(members, &KeptThickness::kept);
  if (first == members.end()) return;
  std::vector<Footprint> cells;
  std::vector<std::int32_t> values;
  for (const KeptThickness& one : members) {
    cells.push_back(one.cells);
    values.insert(values.end(), one.values.begin(), one.values.end());
  }
  write_footprints(file, thickness_group, cells);
  file.set_number(thickness_group, "quantum_m", first->quantum);
  file.write_list<std::int32_t>(std::string(thickness_group) + "/values", values);
}

std::vector<KeptThickness> read_thickness(const h5::File& file, const std::vector<std::int64_t>& of_grids) {
  std::vector<KeptThickness> members(of_grids.size());
  if (!file.exists(thickness_group)) return members;
  const double quantum = h5::checked_number(file, thickness_group, "quantum_m", h5::not_negative);
  const std::vector<Footprint> cells = read_footprints(file, thickness_group, of_grids);
  const std::string path = std::string(thickness_group) + "/values";
  const auto values = file.read_list<std::int32_t>(path, h5::not_negative);
  std::size_t inside = 0;
  for (const Footprint& one : cells) inside += covered_cells(one);
  if (inside != values.size())
    file.refuse(fmt::format("dataset {} has {} values", path, values.size()),
                fmt::format("its footprints have {} cells inside", inside));
  auto next = values.begin();
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto end = next + static_cast<std::ptrdiff_t>(covered_cells(cells[k]));
    members[k] = {cells[k], {next, end}, quantum};
    next = end;
  }
  return members;
}

std::vector<CellWindow> read_member_windows(const h5::File& file, std::size_t count, const MapGrid& grid) {
  auto windows = h5::read_windows(file, "/members/window", count);
  for (std::size_t k = 0; k < count; ++k)
    if (const CellWindow& w = windows[k]; !lies_in(w, grid))
      file.refuse(fmt::format("dataset /members/window holds {} x {} cells from {}, {} at place {}", w.columns, w.rows,
                              w.column, w.row, k),
                  fmt::format("the grid has {} x {}", grid.columns, grid.rows));
  return windows;
}

constexpr const char* gauges_group = "/members/gauges";
constexpr const char* grids_group = "/members/grids";

/// The grids of members whose cells are not the scene's, by member.
std::map<std::int64_t, MapGrid> read_grids(const h5::File& file, const MemberRange& part) {
  std::map<std::int64_t, MapGrid> grids;
  if (!file.exists(grids_group)) return grids;
  for (const std::string& name : file.children(grids_group)) {
    std::int64_t member = -1;
    std::from_chars(name.data(), name.data() + name.size(), member);
    if (member < part.first || member >= part.end)
      file.refuse(fmt::format("group {} names member \"{}\"", grids_group, name), "it is not of this part");
    grids[member] = h5::read_grid(file, fmt::format("{}/{}", grids_group, name));
  }
  return grids;
}

std::vector<std::int64_t> cells_in(const std::vector<CellWindow>& windows) {
  std::vector<std::int64_t> cells;
  for (const CellWindow& w : windows) cells.push_back(std::int64_t{w.columns} * w.rows);
  return cells;
}

void write_members(h5::File& file, const EnsembleCounts& counts) {
  file.make_group("/members");
  std::vector<std::uint8_t> states;
  for (const MemberState state : counts.states) states.push_back(static_cast<std::uint8_t>(state));
  file.write_list<std::uint8_t>("/members/state", states);
  file.make_group("/members/results");
  for (const ResultNumber& number : result_numbers) {
    std::vector<double> values;
    for (const MemberResult& result : counts.results) values.push_back(result.*(number.value));
    const auto path = std::string("/members/results/") + number.name;
    file.write_list<double>(path, values);
    file.set_text(path, "unit", number.unit);
    file.set_text(path, "long_name", number.meaning);
  }
  const auto at_gauges = counts.at_gauges();
  if (!at_gauges.empty()) file.make_group(gauges_group);
  for (const auto& [name, values] : at_gauges) {
    const std::string path = fmt::format("{}/{}", gauges_group, name);
    file.write_list<double>(path, values);
    file.set_text(path, "unit", unit_at_gauge(name));
  }
  h5::write_windows(file, "/members/window", counts.windows);
  write_footprints(file, "/members/release", counts.release);
  write_footprints(file, "/members/flow", counts.flow);
  write_footprints(file, "/members/deposit", counts.deposit);
  write_thickness(file, counts.deposit_thickness);
  if (!counts.grids.empty()) file.make_group(grids_group);
  for (const auto& [member, grid] : counts.grids) {
    const std::string group = fmt::format("{}/{:06}", grids_group, member);
    file.make_group(group);
    h5::write_grid(file, group, grid);
  }
  write_member_words(file, "/failures", counts.failures);
  if (!counts.changes.empty()) write_member_words(file, "/changes", counts.changes);
}

/// Refuses members whose state, failures and footprints do not belong together.
void check_members(const h5::File& file, const EnsembleCounts& counts) {
  const auto state_of = [&](std::int64_t member) {
    const bool in_part = member >= counts.part.first && member < counts.part.end;
    return in_part ? counts.state_of(member) : MemberState::waiting;
  };
  std::vector<std::int64_t> failed, told;
  for (std::size_t place = 0; place < counts.states.size(); ++place) {
    const auto member = counts.part.first + static_cast<std::int64_t>(place);
    if (counts.states[place] == MemberState::failed) failed.push_back(member);
    const bool counted = counts.states[place] == MemberState::counted;
    if (counted != !counts.flow[place].empty() || counted != !counts.deposit[place].empty() ||
        counted != !counts.release[place].empty())
      file.refuse(fmt::format("member {} is{} counted, and has {} footprint", member, counted ? "" : " not",
                              counts.flow[place].empty() ? "no" : "a"),
                  "those that are counted have one");
  }
  for (const MemberWords& failure : counts.failures)
    if (state_of(failure.member) != MemberState::left_out) told.push_back(failure.member);
  if (failed != told)
    file.refuse(fmt::format("{} members failed, and {} failures are told", failed.size(), told.size()),
                "there is one for each of these members, in order");
  for (const Finding& finding : counts.findings)
    if (finding.member != Finding::no_member && state_of(finding.member) == MemberState::waiting)
      file.refuse(fmt::format("dataset /findings names member {}", finding.member), "it has not been run");
}

void read_members(const h5::File& file, EnsembleCounts& counts) {
  const auto count = static_cast<hsize_t>(counts.part.count());
  constexpr h5::Allowed a_state{.low = 0, .high = 3};
  for (const std::uint8_t state : file.read<std::uint8_t>("/members/state", {count}, a_state))
    counts.states.push_back(static_cast<MemberState>(state));
  counts.results.resize(count);
  for (const ResultNumber& number : result_numbers) {
    const auto values = file.read<double>(std::string("/members/results/") + number.name, {count}, h5::finite_or_none);
    for (std::size_t k = 0; k < values.size(); ++k) counts.results[k].*(number.value) = values[k];
  }
  for (const std::string& name : file.exists(gauges_group) ? file.children(gauges_group) : std::vector<std::string>()) {
    const auto values = file.read<double>(fmt::format("{}/{}", gauges_group, name), {count}, h5::finite_or_none);
    for (std::size_t k = 0; k < values.size(); ++k)
      if (counts.states[k] == MemberState::counted) counts.results[k].at_gauges[name] = values[k];
  }
  counts.windows = read_member_windows(file, counts.states.size(), counts.scene.grid);
  counts.grids = read_grids(file, counts.part);
  std::vector<std::int64_t> cells = cells_in(counts.windows);
  counts.release = read_footprints(file, "/members/release", cells);
  counts.flow = read_footprints(file, "/members/flow", cells);
  counts.deposit = read_footprints(file, "/members/deposit", cells);
  for (const auto& [member, grid] : counts.grids)
    cells[static_cast<std::size_t>(member - counts.part.first)] = static_cast<std::int64_t>(grid.count());
  counts.deposit_thickness = read_thickness(file, cells);
  counts.failures = read_member_words(file, "/failures");
  counts.findings = h5::read_findings(file);
  counts.changes = read_member_words(file, "/changes");
  check_members(file, counts);
}

void write_scene(h5::File& file, const EnsembleScene& scene) {
  file.make_group("/scene");
  file.set_text("/scene", "name", scene.scene);
  file.set_text("/scene", "title", scene.title);
  file.set_number("/scene", "threshold_m", scene.threshold);
  file.set_integer("/scene", "distribution", scene.tallied == Tallied::distribution ? 1 : 0);
  h5::write_grid(file, "/scene", scene.grid);
  if (scene.terrain.empty()) return;
  file.write_list<double>("/scene/terrain", scene.terrain);
  file.write_list<double>("/scene/before", scene.before);
  file.write_list<double>("/scene/release_thickness", scene.release_thickness);
}

EnsembleScene read_scene(const h5::File& file) {
  EnsembleScene scene;
  scene.scene = file.text("/scene", "name");
  scene.title = file.text("/scene", "title");
  scene.threshold = h5::checked_number(file, "/scene", "threshold_m", h5::thickness);
  scene.tallied = file.integer("/scene", "distribution") != 0 ? Tallied::distribution : Tallied::largest;
  scene.grid = h5::read_grid(file, "/scene");
  if (!file.exists("/scene/terrain")) return scene;
  const h5::Dims cells{scene.grid.count()};
  scene.terrain = file.read<double>("/scene/terrain", cells, h5::elevation_or_none);
  scene.before = file.read<double>("/scene/before", cells, h5::elevation_or_none);
  scene.release_thickness = file.read<double>("/scene/release_thickness", cells, h5::thickness_or_none);
  return scene;
}

}  // namespace

void write_counts(const std::filesystem::path& path, const EnsembleCounts& counts) {
  h5::write_sealed(path, [&](h5::File& file) {
    h5::set_format(file, counts_format);
    file.set_text("/", "fingerprint", counts.fingerprint);
    file.set_integer("/", "members", counts.members);
    file.set_integer("/", "first", counts.part.first);
    file.set_integer("/", "end", counts.part.end);
    write_scene(file, counts.scene);
    const std::vector<std::size_t> order = write_cells(file, counts.cells);
    file.make_group("/maps");
    for (std::size_t m = 0; m < counts.maps.size(); ++m) write_tally(file, counted_maps[m], counts.maps[m], order);
    write_members(file, counts);
    h5::write_facts(file, "/provenance", counts.provenance);
    h5::write_findings(file, counts.findings);
  });
}

EnsembleCounts read_counts(const std::filesystem::path& path) {
  const h5::File file = open_counts(path);
  EnsembleCounts counts;
  counts.fingerprint = file.text("/", "fingerprint");
  counts.members = file.integer("/", "members");
  counts.part = {file.integer("/", "first"), file.integer("/", "end")};
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (counts.part.first < 0 || counts.part.count() < 0 || counts.part.end > counts.members || counts.members > most)
    file.refuse(fmt::format("is of members {} to {} of {}", counts.part.first, counts.part.end, counts.members),
                "there is no such part");
  counts.scene = read_scene(file);
  read_members(file, counts);
  counts.cells = read_cells(file, counts.scene.grid);
  const TallyShape shape{counts.cells.count(), counts.scene.tallied,
                         counts.count(MemberState::counted) - static_cast<std::int64_t>(counts.grids.size())};
  for (std::size_t m = 0; m < counts.maps.size(); ++m) counts.maps[m] = read_tally(file, counted_maps[m], shape);
  counts.provenance = h5::read_facts(file, "/provenance");
  return counts;
}

Facts counts_facts(const std::filesystem::path& path) { return h5::read_facts(open_counts(path), "/provenance"); }

}  // namespace talus
