// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/report.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/window.hpp"
#include "postprocess/report/filled_page.hpp"
#include "postprocess/report/page.hpp"
#include "postprocess/report/parts.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

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

Json map_json(const ReportInput& input) {
  const auto window = shown_window(input);
  int coarsest = 1;
  Json json{
      {"window", {{"west", window.west}, {"south", window.south}, {"east", window.east}, {"north", window.north}}}};
  json["ground"] = ground_json(input, window, coarsest);
  json["layers"] = layers_json(input, window, coarsest);
  json["frames"] = frames_json(input, window, coarsest);
  json["lines"] = lines_json(input, window);
  json["coarsest"] = coarsest;
  json["relief"] = input.options.writes("report-3d");
  return json;
}

/// The used recipes of earlier stages beside the run, if they belong to it, and this stage's.
std::vector<StageText> texts_of_stages(const Job& job) {
  std::vector<StageText> texts;
  const Facts& facts = job.run.summary.provenance;
  for (const auto& [stage, id] : {std::pair{"preprocess", fact(facts, domain_id)}, {"solve", fact(facts, run_id)}}) {
    const std::filesystem::path file = job.file.parent_path() / (std::string(stage) + ".used.toml");
    std::optional<std::string> text = text_if_there(file);
    if (text && !is_used_recipe_of(*text, id)) {
      warn("used-recipe-of-another-run",
           fmt::format("{}: it is of another run than {}; the report leaves it out", file.string(), id));
      text.reset();
    }
    texts.push_back({stage, std::move(text)});
  }
  texts.push_back({"postprocess", text_if_there(job.out / "postprocess.used.toml")});
  return texts;
}

class ReportWriter : public Writer {
 public:
  std::string name() const override { return "report"; }
  std::vector<std::string_view> words() const override { return {"report", "report-3d"}; }
  bool wanted(const Job& job) const override { return job.options.writes("report"); }
  std::vector<std::string> names() const override { return {"report.html"}; }
  Files write(const Job& job) const override {
    return {write_file(
        job, "report.html",
        report_html({job.run, job.options, job.survey, job.score, job.thalweg, texts_of_stages(job),
                     text_if_there(job.file.parent_path() / "survey" / "survey.json"), job.file, &job.hazard}))};
  }
};

}  // namespace

std::shared_ptr<Writer> report_writer() { return std::make_shared<ReportWriter>(); }

Window shown_window(const ReportInput& input) {
  const auto& grid = input.run.maps.grid;
  auto window = affected_window(input.run.maps, input.options, input.survey);
  const double width = std::min(std::max(window.width(), window.height()), grid.east() - grid.west);
  window.west = std::clamp(0.5 * (window.west + window.east - width), grid.west, grid.east() - width);
  window.east = window.west + width;
  return window;
}

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
