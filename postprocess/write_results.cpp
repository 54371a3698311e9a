// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/write_results.hpp"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/fields/history_table.hpp"
#include "postprocess/maps/avaframe.hpp"
#include "postprocess/maps/geotiff.hpp"
#include "postprocess/maps/gis.hpp"
#include "postprocess/maps/hazard_maps.hpp"
#include "postprocess/maps/history_files.hpp"
#include "postprocess/maps/netcdf.hpp"
#include "postprocess/picture/animation.hpp"
#include "postprocess/picture/map_picture.hpp"
#include "postprocess/report/report.hpp"
#include "postprocess/three_d/three_d.hpp"

namespace talus::postprocess {
namespace {

namespace fs = std::filesystem;

/// What preprocess and solve left beside the run about themselves, where it is of this run.
std::vector<StageText> texts_of_stages(const fs::path& folder, const RunSummary& run) {
  std::vector<StageText> texts;
  const std::string domain = fact(run.provenance, domain_id);
  for (const auto& [stage, id] : {std::pair{"preprocess", domain}, std::pair{"solve", fact(run.provenance, run_id)}}) {
    const fs::path file = folder / (std::string(stage) + ".used.toml");
    std::optional<std::string> text = text_if_there(file);
    if (text && !is_used_recipe_of(*text, id)) {
      log_warning(fmt::format("{}: it is of another run than {}; the report leaves it out", file.string(), id));
      text.reset();
    }
    texts.push_back({stage, std::move(text)});
  }
  return texts;
}

/// What this stage leaves about itself.
std::string used_text(const StageContext& context, const Job& job, const Stage& stage) {
  auto inputs = job.survey ? job.survey->inputs : std::vector<fs::path>{};
  inputs.insert(inputs.begin(), job.file);
  if (job.thalweg.given) inputs.push_back(job.options.thalweg);
  for (const fs::path& polygons : hazard_inputs(job.options)) inputs.push_back(polygons);
  return used_recipe(context, stage, recipe::to_used_toml(job.options, "postprocess"), inputs,
                     {{"run", fact(job.run.summary.provenance, run_id)}, {"CRS", crs_name(job.run.maps.grid.crs_wkt)}});
}

/// Everything under maps/.
void write_maps(StageContext& context, const Job& job) {
  const auto& [file, run, options, survey, thalweg, hazard, budget] = job;
  const auto folder = context.out / "maps";
  make_folder(folder);
  auto& results = context.results;
  const auto maps = write_geotiffs(folder, run, options.nodata_zero ? Outside::zero : Outside::nodata);
  results.insert(results.end(), maps.begin(), maps.end());
  std::vector<ProjectGroup> groups;
  if (budget && !spread_maps(*budget).empty()) groups.push_back(spread_group(*budget));
  const auto for_gis = write_gis(folder, maps, {run, options, survey, &hazard, groups});
  results.insert(results.end(), for_gis.begin(), for_gis.end());
  if (budget) {
    const auto spread = write_spread_maps(folder, run, *budget);
    results.insert(results.end(), spread.begin(), spread.end());
  }
  const auto for_authority = write_hazard_maps(folder, run, hazard);
  results.insert(results.end(), for_authority.begin(), for_authority.end());
  if (options.avaframe) {
    make_folder(folder / "avaframe");
    const auto aliases = write_avaframe(folder / "avaframe", run, settings_text(run, file), options.avaframe_format);
    results.insert(results.end(), aliases.begin(), aliases.end());
  }
  results.push_back(folder / "results.nc");
  NetcdfNotes notes{options.institution, context.command_line, options.start_time, {}};
  if (budget)
    for (const SpreadMap& map : spread_maps(*budget))
      notes.more.push_back({map.name, map.long_name, "m", "area: mean", &map.raster->values});
  write_netcdf(results.back(), run, notes);
}

/// So that new maps never lie beside the scores or the report of an older run.
void remove_older(const fs::path& out) {
  for (const auto* name : {"score.json",
                           "score.txt",
                           "report.html",
                           "animation.mp4",
                           "animation.gif",
                           "gauges.csv",
                           "sections.csv",
                           "buildings.csv",
                           "budget.csv",
                           "budget.json",
                           "maps/deposit_spread.tif",
                           "maps/deposit_spread.qml",
                           "maps/deposit_spread_numerical.tif",
                           "maps/deposit_spread_numerical.qml",
                           "maps/deposit_spread_physical.tif",
                           "maps/deposit_spread_physical.qml",
                           "maps/intensity.tif",
                           "maps/intensity.qml",
                           "maps/reach_cone.tif",
                           "maps/reach_cone.qml",
                           "maps/reach.gpkg",
                           "maps/buildings.gpkg"}) {
    std::error_code none_there;
    fs::remove(out / name, none_there);
  }
  remove_three_d(out / "3d");
}

}  // namespace

void write_results(StageContext& context, const Job& job, const Stage& stage) {
  const auto& [file, run, options, survey, thalweg, hazard, budget] = job;
  const auto score = make_score(run, options, survey, thalweg, &hazard);
  const auto table = to_table(score);
  remove_older(context.out);
  write_maps(context, job);
  const auto write = [&](const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context.results.push_back(context.out / name);
    write_text(context.results.back(), bytes);
  };
  for (const fs::path& made : write_three_d(context.out / "3d", options.three_d, run, PointFrames(file)))
    context.results.push_back(made);
  const PictureInput picture{run, options, survey, score, {}, &hazard};
  write("map.png", map_picture(picture));
  if (options.animation != Animation::none)
    context.results.push_back(write_animation(context.out, picture, options.animation));
  write("history.csv", history_table(run.history));
  write("history.nc", history_netcdf(run, options.start_time));
  for (const auto& [kind, rows] : place_tables(run.history)) write((kind + "s.csv").c_str(), rows);
  if (!hazard.buildings.empty()) write("buildings.csv", buildings_table(hazard.buildings));
  if (budget) {
    write("budget.csv", budget_csv(*budget));
    write("budget.json", budget_json_text(*budget, run));
  }
  const auto used = used_text(context, job, stage);
  write("postprocess.used.toml", used);
  if (options.report) {
    auto stages = texts_of_stages(file.parent_path(), run.summary);
    stages.push_back({"postprocess", used});
    const auto comparison = text_if_there(file.parent_path() / "survey" / "survey.json");
    write("report.html", report_html({run, options, survey, score, thalweg, std::move(stages), comparison, file,
                                      &hazard, budget ? &*budget : nullptr}));
  }
  write("score.txt", table);
  write("score.json", to_json(score));  // last: where it lies, everything is there
  log_info("\n" + table);
  if (budget) log_info("\n" + budget_words(*budget));
}

}  // namespace talus::postprocess
