// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/results.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "common/ensemble/used.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/qgis/project.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "postprocess/ensemble/residual.hpp"

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

struct Written {
  fs::path raster, style_file;
  RasterStyle style;
  std::vector<OutlineFeature> outlines{};
};

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
  const char* no_data = counted_maps[map.tally].early && map.unit == "s"
                            ? "outside the computed domain, or too few members arrive"
                            : "outside the computed domain";
  write_cog(written.raster, {scene.grid, std::move(values)}, map_tags(writing.ensemble, map, hazard, no_data));
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

/// A map beside those of counts, and what it means.
struct OtherMap {
  const char* name;
  std::string title;
  const char *unit, *meaning, *no_data;
  RasterStyle style;
};

void write_other(Writing& writing, ProjectGroup& group, const Raster& raster, const OtherMap& map) {
  Facts facts = ensemble_facts(writing.ensemble);
  facts.insert(facts.end(), {{"QUANTITY", map.title}, {"MEANING", map.meaning}, {"NODATA_MEANING", map.no_data}});
  const fs::path file = writing.folder / (std::string(map.name) + ".tif");
  write_cog(file, raster, raster_tags(map.title, map.unit, std::move(facts)));
  writing.files.insert(writing.files.end(), {file, write_qgis_style(file, map.style)});
  std::string title = map.title;
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  if (map.unit != std::string_view("1")) title += fmt::format(" [{}]", map.unit);
  group.layers.push_back({title, file.filename().string(), false, map.style});
}

void write_residual(Writing& writing, const std::vector<double>& residual) {
  write_other(writing, writing.statistics, {writing.ensemble.counts.scene.grid, residual},
              {"residual_sigma", "residual of the deposit thickness in standard deviations", "1",
               "surveyed less mean thickness, over the root of the squared survey error, discrepancy of the model and "
               "spread of the draws",
               "not surveyed, or no deposit in either", residual_style()});
}

void write_ground(Writing& writing) {
  const EnsembleScene& scene = writing.ensemble.counts.scene;
  const fs::path terrain = writing.folder / "terrain.tif";
  write_cog(terrain, {scene.grid, scene.before},
            raster_tags("elevation of the ground before the failure", "m", ensemble_facts(writing.ensemble)));
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

/// Refuses a survey that was prepared with another domain than the members were computed on.
void judge_survey(const FoundSurvey& found, const fs::path& out, const Ensemble& ensemble) {
  const std::string computed_on = fact(ensemble.counts.provenance, domain_id);
  if (found.id.empty() || computed_on.empty() || found.id == computed_on) return;
  throw DataError({fmt::format("{}: prepared with the domain {}", (out / "survey" / "survey.json").string(), found.id),
                   fmt::format("the members were computed on the domain {}", computed_on),
                   "Run talus-preprocess and talus-solve again, one after the other"});
}

/// The survey of the recipe, on which the members are scored.
std::optional<Survey> survey_of(const StageContext& context, Options options, Ensemble& ensemble, bool alone) {
  FoundSurvey found;
  if (options.survey.from_preprocess) {
    found = read_found_survey(context.out);
    judge_survey(found, context.out, ensemble);
  }
  options.survey.find_in(context.out, found.error_known);
  if (alone) judge_outside(found, context.out);
  const RunMaps maps = base_maps(ensemble.counts.scene);
  std::optional<Survey> survey =
      read_survey(options.survey, maps, options.footprint_threshold,
                  heights_in(ensemble.counts.provenance, "the surface that the members began with"));
  if (alone && survey && !is_accepted(ensemble.counts.findings, "swapped-surveys")) judge_order(*survey, maps);
  return survey;
}

/// Sensitivity of every result worth it.
std::vector<std::pair<std::string, Sensitivity>> sensitivities(const Ensemble& ensemble, const MemberRows& rows) {
  std::vector<std::pair<std::string, Sensitivity>> found;
  for (const RowColumn& column : rows.columns) {
    if (!has_sensitivity(column)) continue;
    stop_if_interrupted("finding the sensitivity");
    found.emplace_back(column.name, sensitivity(ensemble.table, column.values));
  }
  return found;
}

/// The results of an ensemble, of a budget or of slides, written one after another.
struct EnsembleResults {
  StageContext& context;
  const Stage& stage;
  const Options& options;
  const Ensemble& ensemble;
  const std::optional<Survey>& survey;
  bool members_only;
  const MemberRows rows = member_rows(ensemble, options, survey);
  const std::vector<double> residual = residual_in_sigma(ensemble, survey, rows, options);
  const std::string used = used_text();

  void write() {
    for (const char* older : {"probability.nc", "budget.json", "ensemble.html", "slides.nc", "slides.html"})
      remove_for_good(context.out / older);
    write(ensemble.table.slides ? "slides.csv" : "members.csv",
          members_csv(rows, ensemble.table.slides ? "slide" : "member"));
    write("postprocess.used.toml", used);
    if (!rows.likelihood.is_null()) write("likelihood.json", rows.likelihood.dump(2) + "\n");
    if (members_only) return;
    if (ensemble.table.slides) return write_slides();
    ensemble.table.rows.empty() ? write_probabilities() : write_budget();
  }

  /// What this stage leaves about itself; a single run beside the ensemble says it again, with its own inputs.
  std::string used_text() const {
    std::vector<fs::path> inputs = ensemble.files;
    if (survey) inputs.insert(inputs.end(), survey->inputs.begin(), survey->inputs.end());
    const std::string tables = recipe::to_used_toml(options, "postprocess") + used_ensemble(context.recipe, true);
    return used_recipe(context, stage, tables, inputs,
                       {{"ensemble", ensemble.counts.fingerprint},
                        {ensemble.table.slides ? "slides" : "members", members_words(ensemble)},
                        {"CRS", crs_name(ensemble.counts.scene.grid.crs_wkt)}});
  }
  void write(const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context.results.push_back(context.out / name);
    write_text(context.results.back(), bytes);
  }
  fs::path made_folder(const char* name) const {
    make_folder(context.out / name);
    return context.out / name;
  }
  void add(const std::vector<fs::path>& files) {
    context.results.insert(context.results.end(), files.begin(), files.end());
  }
  void write_page(const char* name, const std::vector<std::pair<std::string, Sensitivity>>& sensitive,
                  const BudgetTable* budget) {
    if (!options.writes("report")) return;
    EnsemblePageInput input{ensemble, options, survey, rows, sensitive, {}, budget, residual, calibration()};
    for (const char* before : {"preprocess", "solve"})
      input.stages.push_back({before, text_if_there(context.out / (std::string(before) + ".used.toml"))});
    input.stages.push_back({"postprocess", used});
    write(name, ensemble_html(input));
  }
  /// What the page shows of calibration.json, which holds each run.
  Json calibration() const {
    if (ensemble.table.design != design_name(Design::posterior)) return {};
    const auto json = Json::parse(text_if_there(context.out / "calibration.json").value_or(""), nullptr, false);
    if (!json.is_object() || !json.contains("summary")) return {};
    return {{"prior", json["prior"]}, {"summary", json["summary"]}};
  }
  /// The last result: where it lies, all are there.
  template <class Write>
  void write_netcdf(const char* name, const Write& write) {
    stop_if_interrupted(std::string("writing ") + name);
    context.results.push_back(context.out / name);
    write(context.results.back(), ensemble, rows, options, context.command_line);
  }

  void write_probabilities() {
    for (const ShareScore& one : rows.share_scores)
      log_info(
          fmt::format("{} against {}: {:.1f} % of it is where more than 5 % of the members come; where more than half "
                      "of them come, "
                      "the CSI is {:.3f}; Brier score {:.3f}",
                      one.of, survey->name, 100 * one.held, one.csi, one.brier));
    const auto sensitive = sensitivities(ensemble, rows);
    write("sensitivity.csv", sensitivity_csv(sensitive));
    add(write_probability_maps(made_folder("probability"), ensemble, options, residual));
    write_page("ensemble.html", sensitive, nullptr);
    write_netcdf("probability.nc", write_probability_netcdf);
  }

  void write_budget() {
    const BudgetTable table = budget_table(ensemble, rows, options);
    warn_of_chaos(table);
    write("budget.csv", budget_csv(table));
    add(write_spread_maps(made_folder("budget"), ensemble, options, table));
    write_page("ensemble.html", {}, &table);
    write("budget.json", budget_json(table).dump(2) + "\n");
    log_info("\n" + budget_words(table));
  }

  void write_slides() {
    add(write_slide_files(made_folder("slides"), ensemble, rows));
    write_page("slides.html", {}, nullptr);
    write_netcdf("slides.nc", write_slides_netcdf);
  }
};

/// What is read, as people see it.
std::string found_words(const Ensemble& ensemble) {
  const MapGrid& grid = ensemble.counts.scene.grid;
  const std::string found = members_words(ensemble);
  const std::string cells = fmt::format("{} x {} cells of {:g} m", grid.columns, grid.rows, grid.cell);
  if (ensemble.table.slides) return fmt::format("slides: {}; over {}", found, cells);
  std::string words = fmt::format("ensemble: {}; {}; design {}", found, cells, ensemble.table.design);
  if (!ensemble.table.rows.empty()) return words;
  const double draws = independent_draws(ensemble.table, ensemble.counted());
  return words + fmt::format("; the standard error of a probability of one half is {:.2g}", standard_error(0.5, draws));
}

}  // namespace

std::vector<fs::path> write_probability_maps(const fs::path& folder, const Ensemble& ensemble, const Options& options,
                                             const std::vector<double>& residual) {
  Writing writing{folder, ensemble, options};
  write_maps(writing);
  if (!residual.empty()) write_residual(writing, residual);
  write_ground(writing);
  write_project(writing, "ensemble", {writing.shares, writing.statistics, writing.errors});
  return writing.files;
}

RasterStyle residual_style() { return difference_style({1, 2, 3}, "\u03c3"); }

RasterStyle spread_style(const SpreadMap& map) {
  return class_style(thickness_limits({}, map.raster.values), "m", Ramp::sea);
}

std::vector<fs::path> write_spread_maps(const fs::path& folder, const Ensemble& ensemble, const Options& options,
                                        const BudgetTable& table) {
  Writing writing{folder, ensemble, options};
  ProjectGroup group{"How sure", {}};
  for (const SpreadMap& map : table.spreads)
    write_other(
        writing, group, map.raster,
        {map.name, std::string("spread of the deposit thickness over ") + map.over, "m",
         "largest less smallest thickness at the end, over the recipe itself and the members of its error budget",
         "outside the computed domain", spread_style(map)});
  write_ground(writing);
  write_project(writing, "budget", {group});
  return writing.files;
}

Dependencies ensemble_depends(const StageContext& context) {
  const EnsembleOptions options = ensemble_of(context.recipe);
  const char* last = options.design == Design::slides ? "slides.nc"
                     : options.is_budget()            ? "budget.json"
                                                      : "probability.nc";
  return {{context.out / last}, ensemble_files(context.out)};
}

void run_ensemble(StageContext& context, const Stage& stage, Options options, bool alone, bool members_only) {
  Findings found("postprocess", options.accept);
  Ensemble ensemble = read_ensemble(context);
  options.calibrate = context.recipe.read<CalibrateOptions>("calibrate");
  options.settle_thresholds(ensemble.counts.scene.threshold);
  if (const double counted = ensemble.counts.scene.threshold;
      counted != options.deposit_threshold || counted != options.footprint_threshold)
    warn("two-thresholds",
         fmt::format("members count what is thicker than {:g} m ([solve] map_threshold_m), [postprocess] what is "
                     "thicker than {:g} m (footprint) and {:g} m (deposit): run-outs and areas of members are not "
                     "those of score.json. Leave the thresholds of [postprocess] out, or give all the same",
                     counted, options.footprint_threshold, options.deposit_threshold));
  std::optional<Survey> survey;
  if (!ensemble.table.slides) {
    found.settled([&] { survey = survey_of(context, options, ensemble, alone); });
    if (alone) warn_of_unused("postprocess", options.accept, found.list());
    ensemble.findings = found.list();
  }
  hazard_rule(ensemble, options.hazard);
  log_info(found_words(ensemble));
  if (!context.check_only) EnsembleResults{context, stage, options, ensemble, survey, members_only}.write();
}

}  // namespace talus::postprocess
