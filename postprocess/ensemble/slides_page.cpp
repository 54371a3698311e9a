// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of many slides has of maps and outlines.
#include <algorithm>
#include <cmath>

#include "common/map/crop.hpp"
#include "postprocess/ensemble/write_slides.hpp"
#include "postprocess/picture/hillshade.hpp"
#include "postprocess/report/pack.hpp"

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
    json["quantities"].push_back(quantity_json(what, nullptr, stack_of(input, maps, part, factor)));
  }
  json["hazard"] = nullptr;
  json["coarsest"] = factor;
  return json;
}

}  // namespace

PageParts slide_page_parts(const EnsemblePageInput& input) {
  const CellWindow part = reached_cells(input.ensemble);
  return {maps_json(input, part),
          ensemble_outlines_json(input, reached_part(input.ensemble), cut(input.ensemble.counts.scene.grid, part)),
          no_medoids()};
}

}  // namespace talus::postprocess
