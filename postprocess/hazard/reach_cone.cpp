// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/hazard.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "common/map/usual_reach.hpp"

namespace talus::postprocess {
namespace {

/// A place from which a line falls.
struct Crown {
  double x = 0, y = 0, z = 0;
  double line_at(double other_x, double other_y, double tangent) const {
    return z - tangent * std::hypot(other_x - x, other_y - y);
  }
};

/// More than so many lines would take minutes, and a release of so many cells is as well known by fewer.
constexpr std::size_t most_crowns = 1000;

/// Whether a neighbour of a cell of the release is none, or the map ends there.
bool at_the_edge(const RunMaps& maps, int column, int row) {
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c)
      if (!maps.grid.holds(c, r) || !(maps.initial_thickness[maps.grid.index(c, r)] > 0)) return true;
  }
  return false;
}

/// The cells at the edge of the release, and within it of every block of `side` cells the highest; highest first.
std::vector<Crown> released_places(const RunMaps& maps, int side) {
  std::map<std::pair<int, int>, Crown> highest;
  std::vector<Crown> all;
  for (std::size_t i = 0; i < maps.grid.count(); ++i) {
    if (!(maps.initial_thickness[i] > 0) || !std::isfinite(maps.before[i])) continue;
    const auto [column, row] = maps.grid.cell_of(i);
    const Crown here{maps.grid.x(column), maps.grid.y(row), maps.before[i]};
    if (side > 1 && at_the_edge(maps, column, row)) {
      all.push_back(here);
      continue;
    }
    const auto [place, is_new] = highest.try_emplace({column / side, row / side}, here);
    if (!is_new && here.z > place->second.z) place->second = here;
  }
  for (const auto& [block, crown] : highest) all.push_back(crown);
  std::sort(all.begin(), all.end(), [](const Crown& a, const Crown& b) { return a.z > b.z; });
  return all;
}

/// The places of the release whose lines lie above those of all others somewhere: the highest first. Where they are
/// too many, as on a release flatter than the angle, blocks of cells within it stand for theirs.
std::vector<Crown> crowns_of(const RunMaps& maps, double tangent) {
  for (int side = 1;; side *= 2) {
    std::vector<Crown> kept;
    for (const Crown& one : released_places(maps, side)) {
      const bool below = std::any_of(kept.begin(), kept.end(),
                                     [&](const Crown& other) { return other.line_at(one.x, one.y, tangent) >= one.z; });
      if (!below) kept.push_back(one);
      if (kept.size() > most_crowns && side < maps.grid.columns) break;
    }
    if (kept.size() <= most_crowns || side >= maps.grid.columns) return kept;
  }
}

/// The height of the highest line above the ground of a cell; NaN without ground.
double head_at(const RunMaps& maps, const std::vector<Crown>& crowns, double tangent, std::size_t i) {
  const auto [column, row] = maps.grid.cell_of(i);
  const double x = maps.grid.x(column), y = maps.grid.y(row);
  double line = -1e300;
  for (const Crown& crown : crowns) line = std::max(line, crown.line_at(x, y, tangent));
  return line - maps.before[i];
}

/// The cells over which the line passes on from the release: not what lies behind a ridge that rises above it.
std::vector<double> passed(const RunMaps& maps, const std::vector<Crown>& crowns, double tangent) {
  std::vector<double> head(maps.grid.count(), nan);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t i, bool release) {
    if (!std::isnan(head[i])) return;
    const double here = head_at(maps, crowns, tangent, i);
    if (!(here >= 0) && !(release && std::isfinite(here))) return;
    head[i] = std::max(here, 0.0);
    open.push_back(i);
  };
  for (std::size_t i = 0; i < head.size(); ++i)
    if (maps.initial_thickness[i] > 0) reach(i, true);
  while (!open.empty()) {
    const std::size_t here = open.back();
    open.pop_back();
    each_near(maps.grid, maps.grid.cell_of(here), 1, [&](int c, int r) { reach(maps.grid.index(c, r), false); });
  }
  return head;
}

std::optional<ReachCone> cone_of(const RunMaps& maps, const std::string& name, double tangent, double footprint) {
  const std::vector<Crown> crowns = crowns_of(maps, tangent);
  if (crowns.empty()) return std::nullopt;
  ReachCone cone{name, tangent, passed(maps, crowns, tangent), 0, nan};
  double cells = 0, within = 0;
  for (std::size_t i = 0; i < cone.head.size(); ++i) {
    const bool reached = std::isfinite(cone.head[i]), flooded = maps.peak_thickness[i] > footprint;
    if (reached) cone.area += maps.grid.cell * maps.grid.cell;
    if (flooded) ++cells;
    if (flooded && reached) ++within;
  }
  if (cells > 0) cone.covered = within / cells;
  return cone;
}

}  // namespace

std::vector<double> reached_cells(const ReachCone& cone) {
  std::vector<double> cells(cone.head.size());
  std::transform(cone.head.begin(), cone.head.end(), cells.begin(),
                 [](double head) { return std::isfinite(head) ? 1.0 : 0.0; });
  return cells;
}

std::vector<ReachCone> reach_cones(const RunMaps& maps, double volume, double footprint,
                                   const ReachConeOptions& options) {
  std::vector<std::pair<std::string, double>> wanted;
  if (options.by_volume) {
    for (const ReachRegression& one : reach_regressions())
      if (volume >= one.from_volume) wanted.emplace_back(one.source, one.tangent(volume));
    std::sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  }
  if (options.angle) wanted.insert(wanted.begin(), {"angle_deg", std::tan(*options.angle * std::numbers::pi / 180)});
  std::vector<ReachCone> cones;
  for (const auto& [name, tangent] : wanted)
    if (auto cone = cone_of(maps, name, tangent, footprint)) cones.push_back(std::move(*cone));
  return cones;
}

}  // namespace talus::postprocess
