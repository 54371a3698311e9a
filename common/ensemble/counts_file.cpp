// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Writing and reading counts.h5. Layout: attributes of / = whose counts they are; /scene = grid and ground;
// /maps/NAME = counts of a map; /members = states, results and footprints; /failures, /provenance.
#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/ensemble_file.hpp"
#include "common/run/check_values.hpp"
#include "common/run/grid_attributes.hpp"

namespace talus {
namespace {

const EnsembleFileKind counts_kind{"talus counts", "counts of an ensemble", "Run talus-solve again"};

template <class T>
h5::Dims length_of(const std::vector<T>& list) {
  return {static_cast<hsize_t>(list.size())};
}

/// Counts as the signed numbers that files hold.
std::vector<std::int32_t> in_file(std::span<const std::uint32_t> counts) { return {counts.begin(), counts.end()}; }

std::vector<std::uint32_t> read_counted(const h5::File& file, const std::string& path, std::size_t cells,
                                        std::int64_t most) {
  const auto values = file.read<std::int32_t>(path, {static_cast<hsize_t>(cells)});
  h5::check_values<std::int32_t>(file, path, values,
                                 {.low = 0, .high = static_cast<double>(most), .why = "there are not so many members"});
  return {values.begin(), values.end()};
}

void write_map(h5::File& file, const CountedMap& map, const MapTally& tally) {
  const auto group = std::string("/maps/") + map.name;
  file.make_group(group);
  file.set_text(group, "unit", map.unit);
  file.set_number(group, "quantum", map.quantum);
  file.write<double>(group + "/thresholds", length_of(tally.thresholds), tally.thresholds);
  file.make_group(group + "/exceeded");
  for (std::size_t n = 0; n < tally.thresholds.size(); ++n)
    file.write<std::int32_t>(fmt::format("{}/exceeded/{:03}", group, n), length_of(tally.exceeded[n]),
                             in_file(tally.exceeded[n]));
  file.write<std::int32_t>(group + "/reached", length_of(tally.reached), in_file(tally.reached));
  file.write<std::int64_t>(group + "/sum", length_of(tally.sum), tally.sum);
  file.write<std::int64_t>(group + "/sum_of_squares", length_of(tally.sum_of_squares), tally.sum_of_squares);
  const auto edges = bin_edges(map);
  file.write<std::int64_t>(group + "/bin_edges", {edges.size()}, std::span<const std::int64_t>(edges));
  const auto cells = tally.histograms.cells();
  std::vector<std::int32_t> bins;
  bins.reserve(cells.size() * histogram_bins);
  for (const std::int32_t cell : cells) {
    const auto counts = tally.histograms.of(static_cast<std::size_t>(cell));
    bins.insert(bins.end(), counts.begin(), counts.end());
  }
  file.write<std::int32_t>(group + "/histogram_cells", length_of(cells), cells);
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
    std::uint64_t binned = 0;
    for (const std::uint32_t count : tally.histograms.of(cell)) binned += count;
    if (binned != tally.reached[cell])
      file.refuse(fmt::format("{}: {} members reached cell {}, and its histogram holds {}", group, tally.reached[cell],
                              cell, binned),
                  "they are the same members");
    for (const std::vector<std::uint32_t>& exceeded : tally.exceeded)
      if (exceeded[cell] > tally.reached[cell])
        file.refuse(fmt::format("{}: {} members reached cell {}, and {} pass a threshold", group, tally.reached[cell],
                                cell, exceeded[cell]),
                    "who passes it is there");
  }
}

/// `members`: that are counted.
MapTally read_map(const h5::File& file, const CountedMap& map, std::size_t cells, std::int64_t members) {
  const auto group = std::string("/maps/") + map.name;
  MapTally tally(file.read_list<double>(group + "/thresholds"), cells);
  h5::check_growing(file, group + "/thresholds", tally.thresholds, true);
  for (std::size_t n = 0; n < tally.thresholds.size(); ++n)
    tally.exceeded[n] = read_counted(file, fmt::format("{}/exceeded/{:03}", group, n), cells, members);
  tally.reached = read_counted(file, group + "/reached", cells, members);
  tally.sum = file.read<std::int64_t>(group + "/sum", {static_cast<hsize_t>(cells)});
  h5::check_values<std::int64_t>(file, group + "/sum", tally.sum, h5::not_negative);
  tally.sum_of_squares = file.read<std::int64_t>(group + "/sum_of_squares", {static_cast<hsize_t>(cells)});
  h5::check_values<std::int64_t>(file, group + "/sum_of_squares", tally.sum_of_squares, h5::not_negative);
  read_histograms(file, group, map, tally);
  check_tally(file, group, tally);
  return tally;
}

void write_footprints(h5::File& file, const std::string& group, const std::vector<Footprint>& footprints) {
  std::vector<std::int64_t> ends;
  Footprint all;
  for (const Footprint& one : footprints) {
    all.insert(all.end(), one.begin(), one.end());
    ends.push_back(static_cast<std::int64_t>(all.size()));
  }
  file.make_group(group);
  file.write<std::int64_t>(group + "/ends", length_of(ends), ends);
  file.write<std::int32_t>(group + "/runs", length_of(all), all);
}

std::vector<Footprint> read_footprints(const h5::File& file, const std::string& group, std::size_t count,
                                       std::size_t cells) {
  const auto ends = file.read<std::int64_t>(group + "/ends", {static_cast<hsize_t>(count)});
  const auto runs = file.read_list<std::int32_t>(group + "/runs");
  h5::check_values<std::int32_t>(file, group + "/runs", runs, h5::not_negative);
  std::vector<Footprint> footprints(count);
  std::int64_t begin = 0;
  for (std::size_t k = 0; k < count; begin = ends[k++]) {
    if (ends[k] < begin || ends[k] > static_cast<std::int64_t>(runs.size()))
      file.refuse(fmt::format("dataset {}/ends holds {} at place {}", group, ends[k], k), "no footprint ends there");
    footprints[k].assign(runs.begin() + begin, runs.begin() + ends[k]);
    std::int64_t covered = 0;
    for (const std::int32_t length : footprints[k]) covered += length;
    if (!footprints[k].empty() && covered != static_cast<std::int64_t>(cells))
      file.refuse(fmt::format("the footprint of place {} in {} is of {} cells", k, group, covered),
                  fmt::format("the grid has {}", cells));
  }
  return footprints;
}

void write_members(h5::File& file, const EnsembleCounts& counts) {
  file.make_group("/members");
  std::vector<std::uint8_t> states;
  for (const MemberState state : counts.states) states.push_back(static_cast<std::uint8_t>(state));
  file.write<std::uint8_t>("/members/state", length_of(states), states);
  file.make_group("/members/results");
  for (const ResultNumber& number : result_numbers) {
    std::vector<double> values;
    for (const MemberResult& result : counts.results) values.push_back(result.*(number.value));
    const auto path = std::string("/members/results/") + number.name;
    file.write<double>(path, length_of(values), values);
    file.set_text(path, "unit", number.unit);
    file.set_text(path, "long_name", number.meaning);
  }
  write_footprints(file, "/members/flow", counts.flow);
  write_footprints(file, "/members/deposit", counts.deposit);
  file.make_group("/failures");
  for (std::size_t n = 0; n < counts.failures.size(); ++n) {
    const auto group = fmt::format("/failures/{:06}", n);
    file.make_group(group);
    file.set_integer(group, "member", counts.failures[n].member);
    file.set_text(group, "words", counts.failures[n].words);
  }
}

/// Refuses members whose state, failures and footprints do not belong together.
void check_members(const h5::File& file, const EnsembleCounts& counts) {
  std::vector<std::int64_t> failed, told;
  for (std::size_t place = 0; place < counts.states.size(); ++place) {
    const auto member = counts.part.first + static_cast<std::int64_t>(place);
    if (counts.states[place] == MemberState::failed) failed.push_back(member);
    const bool counted = counts.states[place] == MemberState::counted;
    if (counted != !counts.flow[place].empty() || counted != !counts.deposit[place].empty())
      file.refuse(fmt::format("member {} is{} counted, and has {} footprint", member, counted ? "" : " not",
                              counts.flow[place].empty() ? "no" : "a"),
                  "those that are counted have one");
  }
  for (const MemberFailure& failure : counts.failures) told.push_back(failure.member);
  if (failed != told)
    file.refuse(fmt::format("{} members failed, and {} failures are told", failed.size(), told.size()),
                "there is one for each of these members, in order");
}

void read_members(const h5::File& file, EnsembleCounts& counts) {
  const auto count = static_cast<hsize_t>(counts.part.count());
  const auto states = file.read<std::uint8_t>("/members/state", {count});
  h5::check_values<std::uint8_t>(file, "/members/state", states,
                                 {.low = 0, .high = 2, .why = "there is no such state"});
  for (const std::uint8_t state : states) counts.states.push_back(static_cast<MemberState>(state));
  counts.results.resize(count);
  for (const ResultNumber& number : result_numbers) {
    const auto path = std::string("/members/results/") + number.name;
    const auto values = file.read<double>(path, {count});
    h5::check_values<double>(file, path, values, h5::finite_or_none);
    for (std::size_t k = 0; k < values.size(); ++k) counts.results[k].*(number.value) = values[k];
  }
  const std::size_t cells = counts.scene.grid.count();
  counts.flow = read_footprints(file, "/members/flow", counts.states.size(), cells);
  counts.deposit = read_footprints(file, "/members/deposit", counts.states.size(), cells);
  for (const std::string& name : file.children("/failures")) {
    const auto group = "/failures/" + name;
    counts.failures.push_back({file.integer(group, "member"), file.text(group, "words")});
  }
  check_members(file, counts);
}

void write_scene(h5::File& file, const EnsembleScene& scene) {
  file.make_group("/scene");
  file.set_text("/scene", "name", scene.scene);
  file.set_text("/scene", "title", scene.title);
  file.set_number("/scene", "threshold_m", scene.threshold);
  h5::write_grid(file, "/scene", scene.grid);
  file.write<double>("/scene/terrain", length_of(scene.terrain), scene.terrain);
  file.write<double>("/scene/before", length_of(scene.before), scene.before);
  file.write<double>("/scene/release_thickness", length_of(scene.release_thickness), scene.release_thickness);
}

EnsembleScene read_scene(const h5::File& file) {
  EnsembleScene scene;
  scene.scene = file.text("/scene", "name");
  scene.title = file.text("/scene", "title");
  scene.threshold = h5::checked_number(file, "/scene", "threshold_m", h5::not_negative);
  scene.grid = h5::read_grid(file, "/scene");
  const auto read = [&](const std::string& path, const h5::Allowed& allowed) {
    auto values = file.read<double>(path, {static_cast<hsize_t>(scene.grid.count())});
    h5::check_values<double>(file, path, values, allowed);
    return values;
  };
  scene.terrain = read("/scene/terrain", h5::finite_or_none);
  scene.before = read("/scene/before", h5::finite_or_none);
  scene.release_thickness = read("/scene/release_thickness", h5::not_negative_or_none);
  return scene;
}

}  // namespace

void write_counts(const std::filesystem::path& path, const EnsembleCounts& counts) {
  write_ensemble_file(path, counts_kind, [&](h5::File& file) {
    file.set_text("/", "fingerprint", counts.fingerprint);
    file.set_integer("/", "members", counts.members);
    file.set_integer("/", "first", counts.part.first);
    file.set_integer("/", "end", counts.part.end);
    write_scene(file, counts.scene);
    file.make_group("/maps");
    for (std::size_t m = 0; m < counts.maps.size(); ++m) write_map(file, counted_maps[m], counts.maps[m]);
    write_members(file, counts);
    h5::write_facts(file, "/provenance", counts.provenance);
  });
}

EnsembleCounts read_counts(const std::filesystem::path& path) {
  const h5::File file = open_ensemble_file(path, counts_kind);
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
  for (std::size_t m = 0; m < counts.maps.size(); ++m)
    counts.maps[m] = read_map(file, counted_maps[m], counts.scene.grid.count(), counts.count(MemberState::counted));
  counts.provenance = h5::read_facts(file, "/provenance");
  return counts;
}

Facts counts_facts(const std::filesystem::path& path) {
  return h5::read_facts(open_ensemble_file(path, counts_kind), "/provenance");
}

}  // namespace talus
