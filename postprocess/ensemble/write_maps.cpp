// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GeoTIFFs, styles, outlines and the project of QGIS.
#include "postprocess/ensemble/write_maps.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/qgis/project.hpp"
#include "common/stage/in_threads.hpp"
#include "postprocess/ensemble/facts.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/fields/styles.hpp"
#include "postprocess/fields/window.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

using Kind = EnsembleMapKind;

// As of a single run: green for what was released, ink for what was touched.
const OutlineStyle release_line{{0.0, 0.45, 0.36}, 0.7, false};
const OutlineStyle share_line{{0.12, 0.12, 0.14}, 0.4, false};
constexpr double outlined_shares[] = {0.05, 0.5, 0.95};

/// What is written, collected in the order of the maps.
struct Writing {
  const fs::path& folder;
  const Ensemble& ensemble;
  const Options& options;
  std::vector<fs::path> files{};
  ProjectGroup shares{"Probability", {}}, statistics{"Statistics", {}}, errors{"Sampling error", {}},
      lines{"Outlines", {}};
  OutlineLayer outlines{"probability", {}};
};

/// What came of one map.
struct Written {
  fs::path raster, style_file;
  RasterStyle style;
  std::vector<OutlineFeature> outlines{};
};

void write_raster(const fs::path& file, const MapGrid& grid, std::vector<double> values, const std::string& title,
                  const std::string& unit, Facts facts) {
  const std::string shown = unit_words(unit);
  write_cog(file, {grid, std::move(values)},
            {fmt::format("{} [{}]", title, shown.empty() ? "-" : shown), shown, std::move(facts)});
}

std::vector<OutlineFeature> outlines_of_shares(const EnsembleMap& map, const Raster& raster) {
  std::vector<OutlineFeature> outlines;
  for (const double share : outlined_shares)
    outlines.push_back({fmt::format("{}: {:g} % of members", map.name, 100 * share),
                        outline_above(raster, share),
                        {{"probability", share}, {"threshold", map.level}}});
  return outlines;
}

Written written_map(const Writing& writing, const EnsembleMap& map) {
  stop_if_interrupted("writing " + map.name);
  const EnsembleScene& scene = writing.ensemble.counts.scene;
  const HazardOptions& hazard = writing.options.hazard;
  std::vector<double> values = values_of(writing.ensemble, map, hazard);
  Written written{writing.folder / (map.name + ".tif"), {}, style_of(map, values, hazard)};
  if (map.kind == Kind::share && !counted_maps[map.tally].early)
    written.outlines = outlines_of_shares(map, {scene.grid, values});
  Facts facts = ensemble_facts(writing.ensemble);
  for (auto& fact : map_facts(writing.ensemble, map, hazard)) facts.push_back(std::move(fact));
  facts.emplace_back("NODATA_MEANING", counted_maps[map.tally].early && map.unit == "s"
                                           ? "outside the computed domain, or too few members arrive"
                                           : "outside the computed domain");
  write_raster(written.raster, scene.grid, std::move(values), map.title, map.unit, std::move(facts));
  written.style_file = write_qgis_style(written.raster, written.style);
  return written;
}

void take(Writing& writing, const EnsembleMap& map, Written&& written) {
  writing.files.insert(writing.files.end(), {written.raster, written.style_file});
  std::move(written.outlines.begin(), written.outlines.end(), std::back_inserter(writing.outlines.features));
  const bool first = writing.shares.layers.empty() && map.kind == Kind::share;
  ProjectGroup& group = map.kind == Kind::share || map.kind == Kind::hazard     ? writing.shares
                        : map.kind == Kind::error || map.kind == Kind::to_halve ? writing.errors
                                                                                : writing.statistics;
  group.layers.push_back({map.title, written.raster.filename().string(), first, written.style});
}

/// How many maps are made at a time: each needs its values several times over, and GDAL's tiles.
std::size_t maps_at_a_time(const MapGrid& grid) {
  constexpr double bytes = 4e9, bytes_of_a_cell = 64;
  return std::min(most_threads_that_write,
                  static_cast<std::size_t>(1 + bytes / (bytes_of_a_cell * static_cast<double>(grid.count()))));
}

/// The maps wait for the disk and need one processor each, so some are made at a time.
void write_maps(Writing& writing) {
  const std::vector<EnsembleMap> maps = ensemble_maps(writing.ensemble, writing.options.hazard);
  std::vector<Written> written(maps.size());
  in_threads(
      maps.size(), "writing the maps", [&](std::size_t n) { written[n] = written_map(writing, maps[n]); },
      maps_at_a_time(writing.ensemble.counts.scene.grid));
  for (std::size_t n = 0; n < maps.size(); ++n) take(writing, maps[n], std::move(written[n]));
}

/// The window of all that any member reached, with a margin.
Window reached_window(const Ensemble& ensemble, const Options& options) {
  RunMaps maps = base_maps(ensemble.counts.scene);
  const std::vector<std::uint32_t> reached = ensemble.counts.cells.spread(ensemble.counts.maps[0].reached, 0u);
  Options anywhere = options;
  anywhere.footprint_threshold = 0.5;
  for (std::size_t cell = 0; cell < reached.size(); ++cell) maps.peak_thickness[cell] = reached[cell] > 0 ? 1 : 0;
  return affected_window(maps, anywhere, std::nullopt);
}

void write_ground(Writing& writing) {
  const EnsembleScene& scene = writing.ensemble.counts.scene;
  const fs::path terrain = writing.folder / "terrain.tif";
  write_raster(terrain, scene.grid, scene.before, "elevation of the ground before the failure", "m",
               ensemble_facts(writing.ensemble));
  writing.files.push_back(terrain);
  writing.files.push_back(write_qgis_hillshade_style(terrain));
}

/// The project of these groups between the outlines and the ground; `called`: "ensemble".
void write_project(Writing& writing, const std::string& called, const std::vector<ProjectGroup>& groups) {
  const EnsembleScene& scene = writing.ensemble.counts.scene;
  const fs::path outlines = writing.folder / "outlines.gpkg";
  std::vector<OutlineLayer> layers{
      {"release", {{"release", outline_above({scene.grid, scene.release_thickness}, scene.threshold), {}}}}};
  writing.lines.layers = {{"Release", "outlines.gpkg|layername=release", true, release_line}};
  if (writing.ensemble.table.rows.empty()) {
    layers.insert(layers.begin(), writing.outlines);
    writing.lines.layers.push_back(
        {"Probability of 5, 50 and 95 %", "outlines.gpkg|layername=probability", false, share_line});
  }
  write_outlines(outlines, scene.grid.crs_wkt, layers);
  const Window window = reached_window(writing.ensemble, writing.options);
  QgisProject project{fmt::format("{} ({})", scene.title, called),
                      scene.grid.crs_wkt,
                      {window.west, window.south, window.east, window.north},
                      {writing.lines}};
  project.groups.insert(project.groups.end(), groups.begin(), groups.end());
  project.groups.push_back({"Ground", {{"Terrain before the failure", "terrain.tif", true, HillshadeStyle{}}}});
  const fs::path file = writing.folder / fmt::format("{}-{}.qgs", file_word(scene.scene), called);
  write_qgis_project(file, project);
  writing.files.insert(writing.files.end(), {outlines, file});
}

}  // namespace

std::vector<fs::path> write_probability_maps(const fs::path& folder, const Ensemble& ensemble, const Options& options) {
  Writing writing{folder, ensemble, options};
  write_maps(writing);
  write_ground(writing);
  write_project(writing, "ensemble", {writing.shares, writing.statistics, writing.errors});
  return writing.files;
}

RasterStyle spread_style(const SpreadMap& map) {
  return class_style(thickness_limits({}, map.raster.values), "m", Ramp::sea);
}

std::vector<fs::path> write_spread_maps(const fs::path& folder, const Ensemble& ensemble, const Options& options,
                                        const BudgetTable& table) {
  Writing writing{folder, ensemble, options};
  ProjectGroup group{"How sure", {}};
  for (const SpreadMap& map : table.spreads) {
    const std::string title = std::string("spread of the deposit thickness over ") + map.over;
    Facts facts = ensemble_facts(ensemble);
    facts.insert(facts.end(), {{"QUANTITY", title},
                               {"MEANING",
                                "largest less smallest thickness at the end, over the recipe itself and "
                                "the members of its error budget"},
                               {"NODATA_MEANING", "outside the computed domain"}});
    const fs::path file = folder / (std::string(map.name) + ".tif");
    write_raster(file, map.raster.grid, map.raster.values, title, "m", std::move(facts));
    writing.files.insert(writing.files.end(), {file, write_qgis_style(file, spread_style(map))});
    group.layers.push_back({"S" + title.substr(1) + " [m]", file.filename().string(), false, spread_style(map)});
  }
  write_ground(writing);
  write_project(writing, "budget", {group});
  return writing.files;
}

}  // namespace talus::postprocess
