// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/counts.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"

namespace talus {
namespace {

const std::vector<double>& thresholds_of(const CountedMap& map, const ThresholdOptions& o) {
  const std::string_view name = map.name;
  if (name == "peak_thickness") return o.thickness;
  if (name == "deposit_thickness") return o.deposit;
  if (name == "peak_speed") return o.speed;
  return name == "peak_pressure" ? o.pressure : o.arrival;
}

/// This function moves the members of `part` into `all`, whose range holds theirs.
void take(EnsembleCounts& all, EnsembleCounts&& part) {
  for (std::size_t m = 0; m < all.maps.size(); ++m) all.maps[m].add(part.maps[m]);
  for (std::int64_t k = part.part.first; k < part.part.end; ++k) {
    const auto from = static_cast<std::size_t>(k - part.part.first), to = static_cast<std::size_t>(k - all.part.first);
    if (part.states[from] == MemberState::waiting) continue;
    all.states[to] = part.states[from];
    all.results[to] = part.results[from];
    all.flow[to] = std::move(part.flow[from]);
    all.deposit[to] = std::move(part.deposit[from]);
  }
  all.failures.insert(all.failures.end(), part.failures.begin(), part.failures.end());
}

bool same_scene(const EnsembleScene& a, const EnsembleScene& b) {
  return a.grid.columns == b.grid.columns && a.grid.rows == b.grid.rows && a.grid.west == b.grid.west &&
         a.grid.south == b.grid.south && a.grid.cell == b.grid.cell && a.threshold == b.threshold;
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
  for (std::int64_t k = part.part.first; k < part.part.end; ++k) {
    const bool here = part.states[static_cast<std::size_t>(k - part.part.first)] != MemberState::waiting;
    if (here && all.states[static_cast<std::size_t>(k)] != MemberState::waiting) return k;
  }
  return -1;
}

}  // namespace

std::int64_t EnsembleCounts::count(MemberState state) const { return std::count(states.begin(), states.end(), state); }

void EnsembleCounts::add(std::int64_t member, const RunMaps& run, const MemberResult& result) {
  const auto place = static_cast<std::size_t>(member - part.first);
  for (std::size_t m = 0; m < maps.size(); ++m) maps[m].add(counted_maps[m], run.*(counted_maps[m].values));
  states.at(place) = MemberState::counted;
  results[place] = result;
  flow[place] = footprint_of(run.peak_thickness, scene.threshold);
  deposit[place] = footprint_of(run.deposit_thickness, scene.threshold);
}

void EnsembleCounts::fail(std::int64_t member, std::string words) {
  states.at(static_cast<std::size_t>(member - part.first)) = MemberState::failed;
  const auto after = std::upper_bound(failures.begin(), failures.end(), member,
                                      [](std::int64_t k, const MemberFailure& one) { return k < one.member; });
  failures.insert(after, {member, std::move(words)});
}

EnsembleCounts empty_counts(EnsembleScene scene, std::int64_t members, const MemberRange& part,
                            const ThresholdOptions& thresholds) {
  EnsembleCounts counts;
  counts.members = members;
  counts.part = part;
  for (std::size_t m = 0; m < counts.maps.size(); ++m)
    counts.maps[m] = MapTally(thresholds_of(counted_maps[m], thresholds), scene.grid.count());
  counts.scene = std::move(scene);
  const auto count = static_cast<std::size_t>(part.count());
  counts.states.assign(count, MemberState::waiting);
  counts.results.resize(count);
  counts.flow.resize(count);
  counts.deposit.resize(count);
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
      for (std::size_t m = 0; m < all.maps.size(); ++m)
        all.maps[m] = MapTally(part.maps[m].thresholds, part.scene.grid.count());
    }
    require_alike(all, part, files[n], files[0]);
    if (const std::int64_t twice = shared_member(all, part); twice >= 0)
      throw DataError({fmt::format("{}: member {} is counted in another file as well", files[n].string(), twice),
                       "it would count twice", "Remove one of the files of counts"});
    take(all, std::move(part));
  }
  std::sort(all.failures.begin(), all.failures.end(),
            [](const MemberFailure& a, const MemberFailure& b) { return a.member < b.member; });
  return all;
}

}  // namespace talus
