// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Maps and outlines of the page of an ensemble.
#include <algorithm>
#include <cmath>

#include "common/ensemble/counts.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/stage/machine.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/results.hpp"
#include "postprocess/picture/picture.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

/// Maps cut to the window and made as coarse as the page needs.
struct PageMaps {
  const EnsemblePageInput& input;
  const Window& window;
  int factor;

  Raster shown(const std::vector<double>& values, MergedCells merge) const {
    return coarsened(cut({input.ensemble.counts.scene.grid, values}, window), factor, merge);
  }
};

/// All maps of a kind of one quantity. What is dangerous survives where cells are made one.
Json stack(const PageMaps& page, const std::vector<EnsembleMap>& maps, MergedCells merge) {
  return packed_maps(maps.size(), [&](std::size_t n) {
    stop_if_interrupted("making ensemble.html");
    const EnsembleMap& map = maps[n];
    const HazardOptions& hazard = page.input.options.hazard;
    const std::vector<double> values = values_of(page.input.ensemble, map, hazard);
    return map_on_page(map, style_of(map, values, hazard), page.shown(values, merge));
  });
}

Json spreads(const PageMaps& page, const BudgetTable& budget) {
  return {{"id", "deposit_spread"},
          {"title", "Spread of the deposit"},
          {"unit", "m"},
          {"early", false},
          {"shares", nullptr},
          {"statistics", packed_maps(budget.spreads.size(), [&](std::size_t n) {
             const SpreadMap& map = budget.spreads[n];
             return MapOnPage{map.name,
                              std::string("Over ") + map.over,
                              "m",
                              nan,
                              spread_style(map),
                              page.shown(map.raster.values, MergedCells::largest)};
           })}};
}

Json residuals(const PageMaps& page, const std::vector<double>& residual) {
  return {{"id", "residual"},
          {"title", "Residual after the survey"},
          {"unit", ""},
          {"early", false},
          {"shares", nullptr},
          {"statistics", packed_maps(1, [&](std::size_t) {
             return MapOnPage{"residual_sigma",
                              "Surveyed less mean thickness, in standard deviations",
                              "",
                              nan,
                              residual_style(),
                              page.shown(residual, MergedCells::mean)};
           })}};
}

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

MapOnPage map_on_page(const EnsembleMap& map, RasterStyle style, Raster raster) {
  return {map.name, map.title, unit_words(map.unit), map.level, std::move(style), std::move(raster)};
}

Json packed_maps(std::size_t count, const std::function<MapOnPage(std::size_t)>& made) {
  Json json{{"maps", Json::array()}};
  std::vector<std::vector<double>> frames;
  for (std::size_t n = 0; n < count; ++n) {
    MapOnPage map = made(n);
    auto classes = Json::array();
    double from = map.style.hidden_to > map.style.hidden_from ? map.style.hidden_to : -1e300;
    for (const StyleClass& one : map.style.classes) {
      classes.push_back({{"from", from},
                         {"to", std::isfinite(one.upper) ? Json(one.upper) : Json()},
                         {"colour", hex(one.colour)},
                         {"label", one.label}});
      from = one.upper;
    }
    json["maps"].push_back({{"id", map.id},
                            {"title", map.title},
                            {"unit", map.unit},
                            {"level", std::isfinite(map.level) ? Json(map.level) : Json()},
                            {"classes", std::move(classes)}});
    json["grid"] = grid_json(map.raster.grid);
    frames.push_back(std::move(map.raster.values));
  }
  json["data"] = packed(frames);
  return json;
}

Json quantity_json(const CountedMap& what, Json shares, Json statistics) {
  return {{"id", what.name},     {"title", words_of(what)},     {"unit", unit_words(what.unit)},
          {"early", what.early}, {"shares", std::move(shares)}, {"statistics", std::move(statistics)}};
}

Json ensemble_maps_json(const EnsemblePageInput& input, const Window& window) {
  std::vector<EnsembleMap> all;
  if (input.budget == nullptr) all = ensemble_maps(input.ensemble, input.options.hazard);
  const auto shown = std::count_if(all.begin(), all.end(), [](const EnsembleMap& map) {
    return map.kind != Kind::error && map.kind != Kind::to_halve;  // the page finds these from the shares
  });
  const MapGrid& grid = input.ensemble.counts.scene.grid;
  const MapGrid cut_grid = cut({grid, std::vector<double>(grid.count(), 0.0)}, window).grid;
  const std::size_t cells = std::min(cells_of_one_map, cells_on_page / (static_cast<std::size_t>(shown) + 2));
  const PageMaps page{input, window, factor_for(cut_grid, cells)};
  Json json = ground_json(window, page.shown(input.ensemble.counts.scene.before, MergedCells::mean));
  json["quantities"] = Json::array();
  json["hazard"] = nullptr;
  json["coarsest"] = page.factor;
  if (input.budget != nullptr) {
    json["quantities"].push_back(spreads(page, *input.budget));
    return json;
  }
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) {
    const CountedMap& what = counted_maps[tally];
    std::vector<EnsembleMap> shares, statistics;
    for (const EnsembleMap& map : all) {
      if (map.tally != tally || map.kind == Kind::hazard) continue;
      if (map.kind == Kind::share) shares.push_back(map);
      const bool statistic = map.kind == Kind::quantile || map.kind == Kind::mean || map.kind == Kind::deviation;
      if (statistic) statistics.push_back(map);
    }
    json["quantities"].push_back(
        quantity_json(what, shares.empty() ? Json() : stack(page, shares, MergedCells::largest),
                      stack(page, statistics, what.early ? MergedCells::smallest : MergedCells::largest)));
  }
  if (!input.residual.empty()) json["quantities"].push_back(residuals(page, input.residual));
  if (all.back().kind == Kind::hazard) json["hazard"] = stack(page, {all.back()}, MergedCells::largest);
  return json;
}

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
  if (input.survey) json["survey"] = lines_json(footprint_lines(*input.survey), window);
  return json;
}

}  // namespace talus::postprocess
