// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/results.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/ensemble/counts.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/map/raster.hpp"
#include "common/qgis/project.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

using Kind = EnsembleMapKind;

void add_largest(std::vector<EnsembleMap>& maps, std::size_t tally) {
  const CountedMap& map = counted_maps[tally];
  const std::string words = words_of(map);
  maps.push_back({Kind::largest, tally, 0, nan, map.early ? "earliest_arrival" : std::string("largest_") + map.name,
                  (map.early ? "Earliest " : "Largest ") + words + " of any slide", map.unit});
}

void add_counts(std::vector<EnsembleMap>& maps, const Ensemble& ensemble, std::size_t tally) {
  const CountedMap& map = counted_maps[tally];
  const std::vector<double>& thresholds = ensemble.counts.maps[tally].thresholds;
  for (std::size_t n = 0; n < thresholds.size(); ++n) {
    std::string unit = unit_words(map.unit);
    std::replace(unit.begin(), unit.end(), '/', '_');
    const std::string name =
        fmt::format("{}_{}_{:g}_{}", map.name, map.early ? "before" : "above", thresholds[n], unit);
    const std::string words = fmt::format("{} of {}", words_of(map), threshold_words(map, thresholds[n]));
    maps.push_back({Kind::count, tally, n, thresholds[n], "number_" + name, "Number of slides with " + words, "1"});
    maps.push_back({Kind::share, tally, n, thresholds[n], "share_" + name, "Share of slides with " + words, "1"});
  }
}

/// That part in map coordinates.
Window reached_part(const Ensemble& ensemble) {
  const MapGrid part = cut(ensemble.counts.scene.grid, reached_cells(ensemble));
  return {part.west, part.south, part.east(), part.north()};
}

/// Every kept block of cells with its values, cut off at the grid's edge.
void each_block(const SparseValues& sparse, const std::function<void(const Raster&)>& take) {
  constexpr int side = KeptCells::side;
  const MapGrid& grid = sparse.grid;
  for (std::size_t first = 0; first < sparse.values.size(); first += KeptCells::of_block) {
    const auto [column, row] = sparse.cells.cell(first);
    const CellWindow window{column, row, std::min(side, grid.columns - column), std::min(side, grid.rows - row)};
    Raster block{cut(grid, window), {}};
    for (int r = 0; r < window.rows; ++r)
      for (int c = 0; c < window.columns; ++c)
        block.values.push_back(sparse.values[first + static_cast<std::size_t>(r * side + c)]);
    take(block);
  }
}

Json stack_of(const EnsemblePageInput& input, const std::vector<EnsembleMap>& maps, const CellWindow& part,
              int factor) {
  return packed_maps(maps.size(), [&](std::size_t n) {
    stop_if_interrupted("making slides.html");
    const EnsembleMap& map = maps[n];
    const std::vector<double> values = slide_values(input.ensemble, map);
    return map_on_page(map, style_of(map, values, {}), coarse_map(input.ensemble, map, values, part, factor));
  });
}

Json maps_json(const EnsemblePageInput& input, const CellWindow& part) {
  const Ensemble& ensemble = input.ensemble;
  const Window window = reached_part(ensemble);
  std::vector<EnsembleMap> all = slide_maps(ensemble);
  std::erase_if(all, [](const EnsembleMap& map) { return map.kind == Kind::share; });  // the numbers say as much
  const int factor =
      factor_for(cut(ensemble.counts.scene.grid, part), std::min(cells_of_one_map, cells_on_page / (all.size() + 2)));
  Json json = ground_json(window, cut(ensemble.table.slides->ground, window));
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

const OutlineStyle line_of_release{{0.0, 0.45, 0.36}, 0.7, false};
const OutlineStyle line_of_flow{{0.12, 0.12, 0.14}, 0.4, false};
const OutlineStyle line_of_deposit{{0.6, 0.2, 0.05}, 0.4, true};

/// What is written, collected while it is.
struct SlideFiles {
  const fs::path& folder;
  const Ensemble& ensemble;
  std::vector<fs::path> files{};
  ProjectGroup largest{"Largest of any slide", {}}, counts{"Number of slides", {}}, shares{"Share of slides", {}};
};

void write_slide_map(SlideFiles& out, const EnsembleMap& map) {
  stop_if_interrupted("writing " + map.name);
  const Ensemble& ensemble = out.ensemble;
  const std::vector<double> values = slide_values(ensemble, map);
  const RasterStyle style = style_of(map, values, {});
  const char* no_data = map.kind == Kind::largest ? "no slide came" : "no slide passes the threshold";
  const fs::path file = out.folder / (map.name + ".tif");
  RasterWriter writer(file, ensemble.counts.scene.grid, map_tags(ensemble, map, {}, no_data),
                      RasterWriter::Tiles::sparse);
  SparseValues sparse{ensemble.counts.scene.grid, ensemble.counts.cells, values};
  each_block(sparse, [&](const Raster& block) { writer.write(block); });
  for (int overview = 0; overview < writer.overviews(); ++overview) {
    sparse = halved(sparse, writer.overview_grid(overview), map.kind == Kind::largest && counted_maps[map.tally].early);
    each_block(sparse, [&](const Raster& block) { writer.write_overview(overview, block); });
  }
  writer.finish();
  out.files.push_back(file);
  out.files.push_back(write_qgis_style(file, style));
  ProjectGroup& group = map.kind == Kind::largest ? out.largest : map.kind == Kind::count ? out.counts : out.shares;
  const bool first = map.kind == Kind::largest && out.largest.layers.empty();
  group.layers.push_back({map.title, file.filename().string(), first, style});
}

/// The numbers of a slide's row, for the attributes of its outlines.
std::vector<std::pair<std::string, double>> numbers_of(const MemberRows& rows, std::size_t slide) {
  std::vector<std::pair<std::string, double>> numbers{{"slide", static_cast<double>(slide)}};
  for (const RowColumn& column : rows.columns)
    if (column.words.empty() && std::isfinite(column.values[slide])) {
      std::string name = column.name;
      for (char& c : name)
        if (c == '.' || c == '[' || c == ']') c = '_';
      numbers.emplace_back(std::move(name), column.values[slide]);
    }
  return numbers;
}

OutlineLayer layer_of(const std::string& name, const Ensemble& ensemble, const std::vector<Footprint>& footprints,
                      const MemberRows& rows) {
  OutlineLayer layer{name, {}};
  const EnsembleCounts& counts = ensemble.counts;
  for (std::size_t k = 0; k < footprints.size(); ++k) {
    if (counts.states[k] != MemberState::counted) continue;
    stop_if_interrupted("writing slides.gpkg");
    const MapGrid grid = cut(counts.scene.grid, counts.windows[k]);
    const std::vector<std::uint8_t> cells = cells_of(footprints[k], grid.count());
    layer.features.push_back(
        {ensemble.table.names[k], outline_above({grid, {cells.begin(), cells.end()}}, 0.5), numbers_of(rows, k)});
  }
  return layer;
}

}  // namespace

std::vector<EnsembleMap> slide_maps(const Ensemble& ensemble) {
  std::vector<EnsembleMap> maps;
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) add_largest(maps, tally);
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) add_counts(maps, ensemble, tally);
  return maps;
}

std::vector<double> slide_values(const Ensemble& ensemble, const EnsembleMap& map) {
  std::vector<double> values = kept_values(ensemble, map, {}).values;
  const MapTally& tally = ensemble.counts.maps[map.tally];
  for (std::size_t place = 0; place < values.size(); ++place) {
    const std::uint32_t came = map.kind == Kind::largest ? tally.reached[place] : tally.exceeded[map.threshold][place];
    if (came == 0) values[place] = nan;
  }
  return values;
}

CellWindow reached_cells(const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  const MapGrid& grid = counts.scene.grid;
  int west = grid.columns, south = grid.rows, east = 0, north = 0;
  const std::vector<std::uint32_t>& reached = counts.maps[0].reached;
  for (std::size_t place = 0; place < reached.size(); ++place) {
    if (reached[place] == 0) continue;
    const auto [column, row] = counts.cells.cell(place);
    west = std::min(west, column);
    east = std::max(east, column + 1);
    south = std::min(south, row);
    north = std::max(north, row + 1);
  }
  if (east <= west) return {0, 0, grid.columns, grid.rows};
  const int around = 5 + std::max(east - west, north - south) / 20;
  west = std::max(0, west - around);
  south = std::max(0, south - around);
  return {west, south, std::min(grid.columns, east + around) - west, std::min(grid.rows, north + around) - south};
}

Raster coarse_map(const Ensemble& ensemble, const EnsembleMap& map, const std::vector<double>& values,
                  const CellWindow& part, int factor) {
  const EnsembleCounts& counts = ensemble.counts;
  const bool smallest = map.kind == Kind::largest && counted_maps[map.tally].early;
  MapGrid grid = cut(counts.scene.grid, part);
  grid.cell *= factor;
  grid.columns = (part.columns + factor - 1) / factor;
  grid.rows = (part.rows + factor - 1) / factor;
  Raster coarse{grid, std::vector<double>(grid.count(), nan)};
  for (std::size_t place = 0; place < values.size(); ++place) {
    if (std::isnan(values[place])) continue;
    const auto [column, row] = counts.cells.cell(place);
    const int c = column - part.column, r = row - part.row;
    if (c < 0 || r < 0 || c >= part.columns || r >= part.rows) continue;
    double& value = coarse.at(c / factor, r / factor);
    value = smallest ? std::fmin(value, values[place]) : std::fmax(value, values[place]);  // NaN is passed over
  }
  return coarse;
}

SparseValues halved(const SparseValues& fine, const MapGrid& grid, bool smallest) {
  SparseValues coarse{grid, KeptCells(grid), {}};
  for (std::size_t place = 0; place < fine.values.size(); ++place) {
    if (std::isnan(fine.values[place])) continue;
    const auto [column, row] = fine.cells.cell(place);
    const std::size_t to = coarse.cells.keep(column / 2, grid.rows - 1 - (fine.grid.rows - 1 - row) / 2);
    coarse.values.resize(coarse.cells.count(), nan);
    double& value = coarse.values[to];
    value = smallest ? std::fmin(value, fine.values[place]) : std::fmax(value, fine.values[place]);
  }
  return coarse;
}

PageParts slide_page_parts(const EnsemblePageInput& input) {
  const CellWindow part = reached_cells(input.ensemble);
  return {maps_json(input, part),
          ensemble_outlines_json(input, reached_part(input.ensemble), cut(input.ensemble.counts.scene.grid, part)),
          no_medoids()};
}

std::vector<fs::path> write_slide_files(const fs::path& folder, const Ensemble& ensemble, const MemberRows& rows) {
  SlideFiles out{folder, ensemble};
  const EnsembleCounts& counts = ensemble.counts;
  for (const EnsembleMap& map : slide_maps(ensemble)) write_slide_map(out, map);
  const fs::path ground = folder / "ground.tif", outlines = folder / "slides.gpkg";
  Facts facts = ensemble_facts(ensemble);
  facts.emplace_back("NODATA_MEANING", "in no slide's domain");
  write_cog(ground, ensemble.table.slides->ground,
            {"elevation of the ground, at the centres of these cells [m]", "m", std::move(facts)});
  out.files.push_back(ground);
  out.files.push_back(write_qgis_hillshade_style(ground));
  write_outlines(outlines, counts.scene.grid.crs_wkt,
                 {layer_of("release", ensemble, counts.release, rows), layer_of("flow", ensemble, counts.flow, rows),
                  layer_of("deposit", ensemble, counts.deposit, rows)});
  const ProjectGroup lines{"Outlines",
                           {{"Release", "slides.gpkg|layername=release", true, line_of_release},
                            {"Flow", "slides.gpkg|layername=flow", true, line_of_flow},
                            {"Deposit", "slides.gpkg|layername=deposit", false, line_of_deposit}}};
  const Window part = reached_part(ensemble);
  const fs::path project = folder / (file_word(counts.scene.scene) + "-slides.qgs");
  write_qgis_project(project, {counts.scene.title + " (slides)",
                               counts.scene.grid.crs_wkt,
                               {part.west, part.south, part.east, part.north},
                               {lines,
                                out.largest,
                                out.counts,
                                out.shares,
                                {"Ground", {{"Ground (coarse)", "ground.tif", true, HillshadeStyle{}}}}}});
  out.files.insert(out.files.end(), {outlines, project});
  return out.files;
}

}  // namespace talus::postprocess
