// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/write_slides.hpp"

#include <cmath>

#include <fmt/format.h>

#include "common/ensemble/footprint.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/gis/raster_writer.hpp"
#include "common/map/crop.hpp"
#include "common/qgis/project.hpp"
#include "postprocess/ensemble/facts.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

using Kind = EnsembleMapKind;

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
  Facts facts = ensemble_facts(ensemble);
  for (auto& fact : map_facts(ensemble, map, {})) facts.push_back(std::move(fact));
  facts.emplace_back("NODATA_MEANING", map.kind == Kind::largest ? "no slide came" : "no slide passes the threshold");
  const std::string shown = unit_words(map.unit);
  const fs::path file = out.folder / (map.name + ".tif");
  RasterWriter writer(file, ensemble.counts.scene.grid,
                      {fmt::format("{} [{}]", map.title, shown.empty() ? "-" : shown), shown, std::move(facts)},
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
