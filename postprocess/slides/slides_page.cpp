// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of many slides has of maps and outlines.
#include <algorithm>
#include <cmath>

#include "common/ensemble/footprint.hpp"
#include "common/map/crop.hpp"
#include "postprocess/picture/hillshade.hpp"
#include "postprocess/report/pack.hpp"
#include "postprocess/slides/write_slides.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

/// The maps of one quantity.
Json stack_of(const EnsemblePageInput& input, const std::vector<EnsembleMap>& maps, const CellWindow& part,
              int factor) {
  return packed_maps(maps.size(), [&](std::size_t n) {
    stop_if_interrupted("making slides.html");
    const EnsembleMap& map = maps[n];
    const std::vector<double> values = slide_values(input.ensemble, map);
    return MapOnPage{map.name,
                     map.title,
                     unit_words(map.unit),
                     map.level,
                     style_of(map, values, {}),
                     coarse_map(input.ensemble, map, values, part, factor)};
  });
}

Json maps_json(const EnsemblePageInput& input, const CellWindow& part) {
  const Ensemble& ensemble = input.ensemble;
  const Window window = reached_part(ensemble);
  std::vector<EnsembleMap> all = slide_maps(ensemble);
  std::erase_if(all, [](const EnsembleMap& map) { return map.kind == Kind::share; });  // the numbers say as much
  const int factor =
      factor_for(cut(ensemble.counts.scene.grid, part), std::min(cells_of_one_map, cells_on_page / (all.size() + 2)));
  Json json{
      {"window", {{"west", window.west}, {"south", window.south}, {"east", window.east}, {"north", window.north}}}};
  const Raster ground = cut(ensemble.table.slides->ground, window);
  json["ground"] = {{"grid", grid_json(ground.grid)},
                    {"elevation", packed(ground.values)},
                    {"shade", packed(hillshade(ground.grid, ground.values))}};
  json["quantities"] = Json::array();
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) {
    std::vector<EnsembleMap> maps;
    std::copy_if(all.begin(), all.end(), std::back_inserter(maps),
                 [&](const EnsembleMap& map) { return map.tally == tally; });
    const CountedMap& what = counted_maps[tally];
    json["quantities"].push_back({{"id", what.name},
                                  {"title", words_of(what)},
                                  {"unit", unit_words(what.unit)},
                                  {"early", what.early},
                                  {"shares", nullptr},
                                  {"statistics", stack_of(input, maps, part, factor)}});
  }
  json["hazard"] = nullptr;
  json["coarsest"] = factor;
  return json;
}

/// Outlines of a footprint in half cells from the corner of `part`.
std::vector<std::vector<int>> outlines_on(const Footprint& footprint, const MapGrid& lattice, const CellWindow& window,
                                          const CellWindow& part) {
  const MapGrid grid = cut(lattice, window);
  auto lines = footprint_outlines(cells_of(footprint, grid.count()), grid);
  for (auto& line : lines)
    for (std::size_t n = 0; n < line.size(); n += 2) {
      line[n] += 2 * (window.column - part.column);
      line[n + 1] += 2 * (window.row - part.row);
    }
  return lines;
}

std::size_t numbers_in(const std::vector<std::vector<int>>& lines) {
  std::size_t count = 0;
  for (const auto& line : lines) count += line.size();
  return count;
}

Json outlines_json(const EnsemblePageInput& input, const CellWindow& part) {
  const EnsembleCounts& counts = input.ensemble.counts;
  const MapGrid& lattice = counts.scene.grid;
  const MapGrid shown = cut(lattice, part);
  Json json{{"west", shown.west},       {"south", shown.south},   {"half_cell", 0.5 * shown.cell},
            {"members", Json::array()}, {"flow", Json::array()},  {"deposit", Json::array()},
            {"release", Json::array()}, {"survey", Json::array()}};
  std::size_t numbers = 0;
  const std::size_t most = std::min(counts.states.size(), members_on_page);
  for (std::size_t k = 0; k < most && numbers < outline_numbers; ++k) {
    if (counts.states[k] != MemberState::counted) continue;
    stop_if_interrupted("making slides.html");
    const CellWindow& window = counts.windows[k];
    const auto flow = outlines_on(counts.flow[k], lattice, window, part),
               deposit = outlines_on(counts.deposit[k], lattice, window, part);
    numbers += numbers_in(flow) + numbers_in(deposit);
    json["members"].push_back(k);
    json["flow"].push_back(flow);
    json["deposit"].push_back(deposit);
    for (const auto& line : outlines_on(counts.release[k], lattice, window, part)) {
      auto metres = Json::array();
      for (const int half : line) metres.push_back(0.5 * half * shown.cell);
      json["release"].push_back(std::move(metres));
    }
  }
  return json;
}

}  // namespace

PageParts slide_page_parts(const EnsemblePageInput& input) {
  const CellWindow part = reached_cells(input.ensemble);
  return {maps_json(input, part), outlines_json(input, part), no_medoids()};
}

}  // namespace talus::postprocess
