// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The outlines of the page of an ensemble.
#include <cmath>

#include "common/ensemble/footprint.hpp"
#include "common/map/isolines.hpp"
#include "common/stage/in_threads.hpp"
#include "postprocess/ensemble/page.hpp"
#include "postprocess/picture/layers.hpp"
#include "postprocess/report/pack.hpp"

namespace talus::postprocess {
namespace {

/// Outlines are made of so many members before it is asked whether they are enough for the page.
constexpr std::size_t members_at_a_time = 256;

/// The corners of a line on the raster of half cells: points on straight stretches are left out.
std::vector<int> corners(const Polyline& line, const MapGrid& grid) {
  std::vector<int> points;
  for (const auto& [x, y] : line) {
    const int px = static_cast<int>(std::lround(2 * (x - grid.west) / grid.cell)),
              py = static_cast<int>(std::lround(2 * (y - grid.south) / grid.cell));
    const std::size_t n = points.size();
    if (n >= 2 && points[n - 2] == px && points[n - 1] == py) continue;
    if (n >= 4 && (points[n - 2] - points[n - 4]) * (py - points[n - 1]) ==
                      (points[n - 1] - points[n - 3]) * (px - points[n - 2]))
      points.resize(n - 2);
    points.push_back(px);
    points.push_back(py);
  }
  return points;
}

Json line_of(const Polyline& line, const Window& window) {
  auto list = Json::array();
  for (const auto& [x, y] : line) {
    list.push_back(std::round(10 * (x - window.west)) / 10);
    list.push_back(std::round(10 * (y - window.south)) / 10);
  }
  return list;
}

Json lines_of(const std::vector<Polyline>& lines, const Window& window) {
  auto list = Json::array();
  for (const Polyline& line : lines) list.push_back(line_of(line, window));
  return list;
}

/// The part of a footprint that the window shows; outlines are traced there alone.
std::vector<std::vector<int>> outlines_of(const Footprint& footprint, const MapGrid& grid, const Window& window) {
  const std::vector<std::uint8_t> cells = cells_of(footprint, grid.count());
  const Raster part = cut({grid, {cells.begin(), cells.end()}}, window);
  return footprint_outlines({part.values.begin(), part.values.end()}, part.grid);
}

/// Both outlines of a member; none of one that is not counted.
struct MemberOutlines {
  std::vector<std::vector<int>> flow, deposit;
};

/// Of the members from `first` on, before `end`.
std::vector<MemberOutlines> outlines_of_members(const EnsembleCounts& counts, std::size_t first, std::size_t end,
                                                const Window& window) {
  std::vector<MemberOutlines> outlines(end - first);
  in_threads(outlines.size(), "making ensemble.html", [&](std::size_t n) {
    if (counts.states[first + n] != MemberState::counted) return;
    outlines[n] = {outlines_of(counts.flow[first + n], counts.scene.grid, window),
                   outlines_of(counts.deposit[first + n], counts.scene.grid, window)};
  });
  return outlines;
}

std::size_t count_of(const std::vector<std::vector<int>>& lines) {
  std::size_t count = 0;
  for (const auto& line : lines) count += line.size();
  return count;
}

}  // namespace

std::vector<std::vector<int>> footprint_outlines(const std::vector<std::uint8_t>& cells, const MapGrid& grid) {
  const std::vector<double> inside(cells.begin(), cells.end());
  std::vector<std::vector<int>> outlines;
  for (const Polyline& line : isolines(grid, inside, 0.5, AtEdge::close)) outlines.push_back(corners(line, grid));
  return outlines;
}

Json ensemble_outlines_json(const EnsemblePageInput& input, const Window& window) {
  const EnsembleCounts& counts = input.ensemble.counts;
  const MapGrid& grid = counts.scene.grid;
  const MapGrid part = cut({grid, std::vector<double>(grid.count(), 0.0)}, window).grid;
  Json json{{"west", part.west},        {"south", part.south},   {"half_cell", 0.5 * part.cell},
            {"members", Json::array()}, {"flow", Json::array()}, {"deposit", Json::array()}};
  std::size_t numbers = 0;
  const std::size_t most = std::min(counts.states.size(), members_on_page);
  for (std::size_t first = 0; first < most && numbers < outline_numbers; first += members_at_a_time) {
    const std::size_t end = std::min(most, first + members_at_a_time);
    const std::vector<MemberOutlines> outlines = outlines_of_members(counts, first, end, window);
    for (std::size_t k = first; k < end && numbers < outline_numbers; ++k) {
      if (counts.states[k] != MemberState::counted) continue;
      const auto& [flow, deposit] = outlines[k - first];
      numbers += count_of(flow) + count_of(deposit);
      json["members"].push_back(k);
      json["flow"].push_back(flow);
      json["deposit"].push_back(deposit);
    }
  }
  json["release"] =
      lines_of(isolines(grid, counts.scene.release_thickness, counts.scene.threshold, AtEdge::close), window);
  json["survey"] = Json::array();
  if (input.survey && !input.survey->polygons.empty())
    json["survey"] = lines_of(rings(input.survey->polygons), window);
  else if (input.survey && !input.survey->footprint.empty())
    json["survey"] = lines_of(
        isolines(input.survey->grid, input.survey->footprint, input.survey->footprint_threshold, AtEdge::close),
        window);
  return json;
}

}  // namespace talus::postprocess
