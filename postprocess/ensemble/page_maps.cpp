// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of the page of an ensemble.
#include <algorithm>
#include <cmath>

#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/page.hpp"
#include "postprocess/ensemble/write_maps.hpp"
#include "postprocess/picture/hillshade.hpp"
#include "postprocess/report/pack.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

/// Maps cut to the window and made as coarse as the page needs.
class PageMaps {
 public:
  PageMaps(const EnsemblePageInput& input, const Window& window, std::size_t maps, int& coarsest)
      : input_(input), window_(window), coarsest_(coarsest) {
    const MapGrid& grid = input.ensemble.counts.scene.grid;
    const MapGrid cut_grid = cut({grid, std::vector<double>(grid.count(), 0.0)}, window).grid;
    factor_ = factor_for(cut_grid, std::min(cells_of_one_map, cells_on_page / std::max<std::size_t>(maps, 1)));
    coarsest_ = std::max(coarsest_, factor_);
  }

  std::vector<double> values(const EnsembleMap& map) const {
    return values_of(input_.ensemble, map, input_.options.hazard);
  }
  Raster shown(const std::vector<double>& values, MergedCells merge) const {
    return coarsened(cut({input_.ensemble.counts.scene.grid, values}, window_), factor_, merge);
  }
  const HazardOptions& hazard() const { return input_.options.hazard; }

 private:
  const EnsemblePageInput& input_;
  const Window& window_;
  int& coarsest_;
  int factor_ = 1;
};

/// All maps of a kind of one quantity. What is dangerous survives where cells are made one.
Json stack(const PageMaps& page, const std::vector<EnsembleMap>& maps, MergedCells merge) {
  return packed_maps(maps.size(), [&](std::size_t n) {
    stop_if_interrupted("making ensemble.html");
    const EnsembleMap& map = maps[n];
    const std::vector<double> values = page.values(map);
    return MapOnPage{map.name,
                     map.title,
                     unit_words(map.unit),
                     map.level,
                     style_of(map, values, page.hazard()),
                     page.shown(values, merge)};
  });
}

/// The maps of spread of a budget, as a quantity.
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

Json ground(const PageMaps& page, const EnsembleScene& scene) {
  const Raster elevation = page.shown(scene.before, MergedCells::mean);
  return {{"grid", grid_json(elevation.grid)},
          {"elevation", packed(elevation.values)},
          {"shade", packed(hillshade(elevation.grid, elevation.values))}};
}

}  // namespace

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

Json ensemble_maps_json(const EnsemblePageInput& input, const Window& window, int& coarsest) {
  std::vector<EnsembleMap> all;
  if (input.budget == nullptr) all = ensemble_maps(input.ensemble, input.options.hazard);
  const auto shown = std::count_if(all.begin(), all.end(), [](const EnsembleMap& map) {
    return map.kind != Kind::error && map.kind != Kind::to_halve;  // the page finds these from the shares
  });
  const PageMaps page(input, window, static_cast<std::size_t>(shown) + 2, coarsest);
  Json json{
      {"window", {{"west", window.west}, {"south", window.south}, {"east", window.east}, {"north", window.north}}}};
  json["ground"] = ground(page, input.ensemble.counts.scene);
  json["quantities"] = Json::array();
  json["hazard"] = nullptr;
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
  if (all.back().kind == Kind::hazard) json["hazard"] = stack(page, {all.back()}, MergedCells::largest);
  return json;
}

}  // namespace talus::postprocess
