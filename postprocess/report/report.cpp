// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/map/raster.hpp"
#include "common/recipe/used.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/picture/picture.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// A thickness map read both ways: vertical, as Talus means it, and as if it were measured normal to the slope.
Json both_ways(const std::string& name, const Raster& thickness, const ReleaseNumbers& numbers, double limit) {
  double vertical = 0;
  for (const double h : thickness.values)
    if (h > 0) vertical += h * (thickness.grid.cell * thickness.grid.cell);
  return {{"name", name},
          {"volume", vertical},
          {"volume_if_normal", numbers.volume_if_normal},
          {"area_projected", numbers.area},
          {"area_true", numbers.true_area},
          {"thickest", numbers.thickest},
          {"thickest_normal", numbers.thickest_normal},
          {"limit", limit}};
}

Json entry_json(const ScoreEntry& entry) {
  Json json{{"key", entry.key}, {"label", entry.label}, {"unit", entry.unit}, {"decimals", entry.decimals}};
  std::visit([&](const auto& value) { json["value"] = value; }, entry.value);
  return json;
}

Json building_json(const Building& b) {
  return {{"name", b.name},
          {"arrival", finite_or_null(b.arrival)},
          {"thickness", {b.thickness.largest, b.thickness.p99}},
          {"speed", {b.speed.largest, b.speed.p99}},
          {"pressure", {b.pressure.largest, b.pressure.p99}},
          {"width", b.width},
          {"force", b.force},
          {"force_from", source_word(b.source)}};
}

/// Of every quantity measured at a place its value farthest from zero, and when that was.
Json extremes_at(const std::string& place, const RunHistory& history) {
  auto list = Json::array();
  const HistoryColumn* time = history.find("time_s");
  for (const HistoryColumn& column : history.columns) {
    if (column.place != place || time == nullptr) continue;
    const auto farther = [](double a, double b) { return !std::isfinite(a) || std::abs(a) < std::abs(b); };
    const auto found = std::max_element(column.values.begin(), column.values.end(), farther);
    if (found == column.values.end() || !std::isfinite(*found)) continue;
    list.push_back({{"quantity", column.quantity},
                    {"unit", column.unit},
                    {"value", *found},
                    {"time", time->values[static_cast<std::size_t>(found - column.values.begin())]}});
  }
  return list;
}

Json run_json(const ReportInput& input) {
  const auto& s = input.run.summary;
  const auto& options = input.options;
  Json json{{"title", s.title}, {"scene", s.scene}, {"version", version()}, {"run_version", s.version}};
  json["made"] = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  json["hardware"] = hardware();
  json["institution"] = options.institution;
  json["crs"] = crs_name(input.run.maps.grid.crs_wkt);
  json["map"] = {
      {"columns", input.run.maps.grid.columns}, {"rows", input.run.maps.grid.rows}, {"cell", input.run.maps.grid.cell}};
  json["thresholds"] = {{"footprint", options.footprint_threshold},
                        {"deposit", options.deposit_threshold},
                        {"map", input.run.maps.threshold}};
  json["density"] = s.density;
  json["material"] = s.material;
  json["bed"] = s.bed;
  json["survey"] = nullptr;
  if (const auto& survey = input.survey)
    json["survey"] = {{"name", survey->name},
                      {"is_model", survey->kind == ReferenceKind::model},
                      {"noun", survey->words().noun},
                      {"adjective", survey->words().adjective},
                      {"is_change", survey->deposit_is_change},
                      {"is_polygon", !survey->polygons.empty()},
                      {"footprint_threshold", survey->footprint_threshold}};
  return json;
}

/// What came to each building.
Json hazard_json(const ReportInput& input) {
  Json json{{"buildings", Json::array()}};
  if (input.hazard != nullptr)
    for (const Building& b : input.hazard->buildings) json["buildings"].push_back(building_json(b));
  return json;
}

/// The sections and entries of a score, and what was not scored.
Json score_json(const Score& score) {
  Json json{{"sections", Json::array()},
            {"not_scored", Json::array()},
            {"belief", score.belief},
            {"notes", score.notes},
            {"findings", Json::parse(to_json(score.findings))}};
  for (const auto& section : score.sections) {
    auto entries = Json::array();
    for (const auto& entry : section.entries) entries.push_back(entry_json(entry));
    json["sections"].push_back({{"title", section.title}, {"entries", std::move(entries)}});
  }
  for (const auto& [key, why] : score.not_scored) json["not_scored"].push_back({{"key", key}, {"why", why}});
  return json;
}

Json map_json(const ReportInput& input) {
  const auto window = shown_window(input);
  int coarsest = 1;
  Json json = ground_json(window, shown_ground(input, window, coarsest));
  json["layers"] = layers_json(input, window, coarsest);
  json["frames"] = frames_json(input, window, coarsest);
  json["lines"] = lines_json(input, window);
  json["coarsest"] = coarsest;
  json["relief"] = input.options.writes("report-3d");
  return json;
}

/// The used recipes of earlier stages beside the run, if they belong to it, and this stage's. `other`: called with the
/// file and the run's id where one does not.
template <class Other>
std::vector<StageText> texts_of_stages(const Job& job, const Other& other) {
  std::vector<StageText> texts;
  const Facts& facts = job.run.summary.provenance;
  for (const auto& [stage, id] : {std::pair{"preprocess", fact(facts, domain_id)}, {"solve", fact(facts, run_id)}}) {
    const std::filesystem::path file = job.file.parent_path() / (std::string(stage) + ".used.toml");
    std::optional<std::string> text = text_if_there(file);
    if (text && !is_used_recipe_of(*text, id)) {
      other(file, id);
      text.reset();
    }
    texts.push_back({stage, std::move(text)});
  }
  texts.push_back({"postprocess", text_if_there(job.out / "postprocess.used.toml")});
  return texts;
}

/// Before anything is written, so that the scores have it too.
void warn_of_other_recipes(const Job& job) {
  texts_of_stages(job, [](const std::filesystem::path& file, const std::string& id) {
    warn("used-recipe-of-another-run",
         fmt::format("{}: it is of another run than {}; the report leaves it out", file.string(), id));
  });
}

std::string report_of(const Job& job) {
  return report_html({job.run, job.options, job.survey, job.score, job.thalweg,
                      texts_of_stages(job, [](const auto&, const auto&) {}),
                      text_if_there(job.file.parent_path() / "survey" / "survey.json"), job.file, &job.hazard});
}

}  // namespace

Json volumes_json(const Run& run, double deposit_threshold) {
  const auto cosine = slope_cosine({run.maps.grid, run.maps.terrain});
  const auto& maps = run.maps;
  auto bodies = Json::array();
  const double limit = release_limit(maps, deposit_threshold);
  bodies.push_back(both_ways("Release", {maps.grid, maps.initial_thickness}, release_numbers(run, limit), limit));
  const auto add = [&](const char* name, const Raster& thickness, double least) {
    bodies.push_back(both_ways(name, thickness, numbers_of(thickness, cosine, least), least));
  };
  add("Deposit", {maps.grid, maps.deposit_thickness}, deposit_threshold);
  if (!maps.eroded_depth.empty()) add("Eroded ground", {maps.grid, maps.eroded_depth}, 0);
  return bodies;
}

Json stages_json(const std::vector<StageText>& stages) {
  auto list = Json::array();
  for (const auto& stage : stages) {
    Json json{{"stage", stage.stage}, {"missing", !stage.text}, {"facts", Json::array()}, {"keys", Json::array()}};
    if (stage.text) {
      const auto used = recipe::read_used_recipe(*stage.text, stage.stage + ".used.toml");
      for (const auto& [name, value] : used.facts)
        if (name != "table" && name != "result" && name != "resolved") json["facts"].push_back({name, value});
      for (const auto& key : used.keys)
        json["keys"].push_back({{"table", key.table},
                                {"key", key.key},
                                {"value", key.value},
                                {"default", key.default_value ? Json(*key.default_value) : Json()}});
    }
    list.push_back(std::move(json));
  }
  return list;
}

Json places_json(const ReportInput& input) {
  auto list = Json::array();
  const Window window = shown_window(input);
  for (const MapPlace& place : input.run.summary.places) {
    auto rings = Json::array();
    for (const auto& ring : place.rings) {
      auto flat = Json::array();
      for (const auto& [x, y] : ring) {
        flat.push_back(std::round(100 * (x - window.west)) / 100);
        flat.push_back(std::round(100 * (y - window.south)) / 100);
      }
      rings.push_back(std::move(flat));
    }
    list.push_back({{"kind", place.words.substr(0, place.words.find(' '))},
                    {"name", name_of(place)},
                    {"rings", std::move(rings)},
                    {"measured", extremes_at(place.words, input.run.history)}});
  }
  return list;
}

Writer report_writer() {
  return {.name = "report",
          .names = {"report.html"},
          .write = [](const Job& job) { return Files{write_file(job, "report.html", report_of(job))}; },
          .words = {"report", "report-3d"},
          .asked_for = [](const Job& job) { return job.options.writes("report"); },
          .check = warn_of_other_recipes};
}

Window shown_window(const ReportInput& input) { return page_window(input.run.maps, input.options, input.survey); }

std::string report_html(const ReportInput& input) {
  Json data;
  data["run"] = run_json(input);
  data["score"] = score_json(input.score);
  data["volumes"] = volumes_json(input.run, input.options.deposit_threshold);
  data["surveys"] = input.comparison ? Json::parse(*input.comparison, nullptr, false) : Json(nullptr);
  if (data["surveys"].is_discarded())
    throw DataError(
        {"survey/survey.json beside the run is no JSON", "it was cut short or edited", "Run talus-preprocess again"});
  data["stages"] = stages_json(input.stages);
  data["profile"] = profile_json(input);
  data["series"] = series_json(input);
  data["hazard"] = hazard_json(input);
  data["map"] = map_json(input);
  data["places"] = places_json(input);
  for (const char* part : {"score", "surveys", "stages"}) leave_out_folders(data[part]);
  return filled_page(page_template(), input.run.summary.title, data);
}

}  // namespace talus::postprocess
