// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "common/gis/geotiff.hpp"
#include "common/qgis/style.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/budget/budget_table.hpp"
#include "postprocess/fields/styles.hpp"

namespace talus::postprocess {

std::vector<SpreadMap> spread_maps(const BudgetTable& table) {
  std::vector<SpreadMap> maps{
      {"deposit_spread", "spread of the deposit thickness over all doubts", &table.spread},
      {"deposit_spread_physical", "spread of the deposit thickness over doubts about the slide",
       &table.spread_physical},
      {"deposit_spread_numerical", "spread of the deposit thickness over doubts about the computation",
       &table.spread_numerical}};
  std::erase_if(maps, [](const SpreadMap& map) { return map.raster->values.empty(); });
  return maps;
}

namespace {

RasterStyle style_of(const Raster& spread) { return class_style(thickness_limits({}, spread.values), "m", Ramp::sea); }

}  // namespace

ProjectGroup spread_group(const BudgetTable& table) {
  ProjectGroup group{"How sure", {}};
  for (const auto& [name, long_name, raster] : spread_maps(table)) {
    std::string legend = std::string(long_name) + " [m]";
    legend.front() = 'S';
    group.layers.push_back({legend, std::string(name) + ".tif", false, style_of(*raster)});
  }
  return group;
}

std::vector<std::filesystem::path> write_spread_maps(const std::filesystem::path& folder, const Run& run,
                                                     const BudgetTable& table) {
  std::vector<std::filesystem::path> files;
  for (const auto& [name, long_name, raster] : spread_maps(table)) {
    RasterTags tags{fmt::format("{} [m]", long_name), "m", {}};
    tags.metadata = {
        {"TITLE", run.summary.title},
        {"SCENE", run.summary.scene},
        {"RUN_ID", fact(run.summary.provenance, run_id)},
        {"QUANTITY", long_name},
        {"MEANING", "largest less smallest thickness at the end, over the run and those of its error budget"},
        {"NODATA_MEANING", "outside the computed domain"},
        {"SOURCE", "Talus " + run.summary.version}};
    files.push_back(folder / (std::string(name) + ".tif"));
    write_cog(files.back(), *raster, tags);
    files.push_back(write_qgis_style(files.back(), style_of(*raster)));
  }
  return files;
}

}  // namespace talus::postprocess
