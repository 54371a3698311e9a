// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of the page of an ensemble.
#include <algorithm>
#include <cmath>

#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/page.hpp"
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

/// All maps of a kind of one quantity, packed end to end. What is dangerous survives where cells are made one.
Json stack(const PageMaps& page, const std::vector<EnsembleMap>& maps, MergedCells merge) {
  Json json{{"maps", Json::array()}};
  std::vector<std::vector<double>> frames;
  for (const EnsembleMap& map : maps) {
    stop_if_interrupted("making ensemble.html");
    const std::vector<double> values = page.values(map);
    const Raster raster = page.shown(values, merge);
    json["maps"].push_back({{"id", map.name},
                            {"title", map.title},
                            {"unit", unit_words(map.unit)},
                            {"level", std::isfinite(map.level) ? Json(map.level) : Json()},
                            {"classes", classes_json(map, values, page.hazard())}});
    json["grid"] = grid_json(raster.grid);
    frames.push_back(raster.values);
  }
  json["data"] = packed(frames);
  return json;
}

Json ground(const PageMaps& page, const EnsembleScene& scene) {
  const Raster elevation = page.shown(scene.before, MergedCells::mean);
  return {{"grid", grid_json(elevation.grid)},
          {"elevation", packed(elevation.values)},
          {"shade", packed(hillshade(elevation.grid, elevation.values))}};
}

}  // namespace

Json classes_json(const EnsembleMap& map, const std::vector<double>& values, const HazardOptions& hazard) {
  const RasterStyle style = style_of(map, values, hazard);
  auto list = Json::array();
  double from = style.hidden_to > style.hidden_from ? style.hidden_to : -1e300;
  for (const StyleClass& one : style.classes) {
    list.push_back({{"from", from},
                    {"to", std::isfinite(one.upper) ? Json(one.upper) : Json()},
                    {"colour", hex(one.colour)},
                    {"label", one.label}});
    from = one.upper;
  }
  return list;
}

Json ensemble_maps_json(const EnsemblePageInput& input, const Window& window, int& coarsest) {
  const std::vector<EnsembleMap> all = ensemble_maps(input.ensemble, input.options.hazard);
  const auto shown = std::count_if(all.begin(), all.end(), [](const EnsembleMap& map) {
    return map.kind != Kind::error && map.kind != Kind::to_halve;  // the page finds these from the shares
  });
  const PageMaps page(input, window, static_cast<std::size_t>(shown) + 2, coarsest);
  Json json{
      {"window", {{"west", window.west}, {"south", window.south}, {"east", window.east}, {"north", window.north}}}};
  json["ground"] = ground(page, input.ensemble.counts.scene);
  json["quantities"] = Json::array();
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
        {{"id", what.name},
         {"title", words_of(what)},
         {"unit", unit_words(what.unit)},
         {"early", what.early},
         {"shares", shares.empty() ? Json() : stack(page, shares, MergedCells::largest)},
         {"statistics", stack(page, statistics, what.early ? MergedCells::smallest : MergedCells::largest)}});
  }
  json["hazard"] = nullptr;
  if (all.back().kind == Kind::hazard) json["hazard"] = stack(page, {all.back()}, MergedCells::largest);
  return json;
}

}  // namespace talus::postprocess
