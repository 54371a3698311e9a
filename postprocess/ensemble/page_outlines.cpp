// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The outlines of the page of an ensemble.
#include <cmath>

#include "common/ensemble/footprint.hpp"
#include "common/map/crop.hpp"
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

/// Outlines of a member's footprint in half cells from the corner of `shown`. Of an ensemble the part that the window
/// shows is traced; of slides, whose domains are small, the whole.
std::vector<std::vector<int>> outlines_of(const Footprint& footprint, const MapGrid& grid, const Window* window,
                                          const MapGrid& shown) {
  const std::vector<std::uint8_t> cells = cells_of(footprint, grid.count());
  Raster part{grid, {cells.begin(), cells.end()}};
  if (window != nullptr) part = cut(part, *window);
  const auto half_cells = [&](double metres) { return static_cast<int>(std::lround(2 * metres / shown.cell)); };
  const int east = half_cells(part.grid.west - shown.west), north = half_cells(part.grid.south - shown.south);
  auto lines = footprint_outlines({part.values.begin(), part.values.end()}, part.grid);
  for (auto& line : lines)
    for (std::size_t n = 0; n < line.size(); n += 2) {
      line[n] += east;
      line[n + 1] += north;
    }
  return lines;
}

/// The outlines of a member; none of one that is not counted.
struct MemberOutlines {
  std::vector<std::vector<int>> flow, deposit, release;
};

/// Of the members from `first` on, before `end`; the release of slides alone.
std::vector<MemberOutlines> outlines_of_members(const Ensemble& ensemble, std::size_t first, std::size_t end,
                                                const Window& window, const MapGrid& shown) {
  const EnsembleCounts& counts = ensemble.counts;
  std::vector<MemberOutlines> outlines(end - first);
  in_threads(outlines.size(), "making the page", [&](std::size_t n) {
    const std::size_t k = first + n;
    if (counts.states[k] != MemberState::counted) return;
    const MapGrid grid = cut(counts.scene.grid, counts.windows[k]);
    const auto of = [&](const Footprint& footprint) {
      return outlines_of(footprint, grid, ensemble.table.slides ? nullptr : &window, shown);
    };
    outlines[n] = {of(counts.flow[k]), of(counts.deposit[k]), {}};
    if (ensemble.table.slides) outlines[n].release = of(counts.release[k]);
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

Json ensemble_outlines_json(const EnsemblePageInput& input, const Window& window, const MapGrid& shown) {
  const EnsembleCounts& counts = input.ensemble.counts;
  const MapGrid& grid = counts.scene.grid;
  Json json{{"west", shown.west},       {"south", shown.south},   {"half_cell", 0.5 * shown.cell},
            {"members", Json::array()}, {"flow", Json::array()},  {"deposit", Json::array()},
            {"release", Json::array()}, {"survey", Json::array()}};
  std::size_t numbers = 0;
  const std::size_t most = std::min(counts.states.size(), members_on_page);
  for (std::size_t first = 0; first < most && numbers < outline_numbers; first += members_at_a_time) {
    const std::size_t end = std::min(most, first + members_at_a_time);
    const std::vector<MemberOutlines> outlines = outlines_of_members(input.ensemble, first, end, window, shown);
    for (std::size_t k = first; k < end && numbers < outline_numbers; ++k) {
      if (counts.states[k] != MemberState::counted) continue;
      const auto& [flow, deposit, release] = outlines[k - first];
      numbers += count_of(flow) + count_of(deposit);
      json["members"].push_back(k);
      json["flow"].push_back(flow);
      json["deposit"].push_back(deposit);
      for (const std::vector<int>& line : release) {
        auto metres = Json::array();
        for (const int half : line) metres.push_back(0.5 * half * shown.cell);
        json["release"].push_back(std::move(metres));
      }
    }
  }
  if (!input.ensemble.table.slides)
    json["release"] =
        lines_json(isolines(grid, counts.scene.release_thickness, counts.scene.threshold, AtEdge::close), window);
  if (input.survey && !input.survey->polygons.empty())
    json["survey"] = lines_json(rings(input.survey->polygons), window);
  else if (input.survey && !input.survey->footprint.empty())
    json["survey"] = lines_json(
        isolines(input.survey->grid, input.survey->footprint, input.survey->footprint_threshold, AtEdge::close),
        window);
  return json;
}

}  // namespace talus::postprocess
