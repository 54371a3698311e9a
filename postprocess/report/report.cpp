// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/report.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/recipe/shown_paths.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/window.hpp"
#include "postprocess/report/pack.hpp"
#include "postprocess/report/page.hpp"
#include "postprocess/report/parts.hpp"

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
  return json;
}

/// JSON inside <script>: no "<" may stand there, or a title could end the block.
std::string for_script(const Json& json) {
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

std::string for_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else
      safe += c;
  }
  return safe;
}

/// The bytes of a SHA-256 given in hex.
std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

/// The sources that a Content-Security-Policy names for what stands between `open` and `close` in the page:
/// "'sha256-..' 'sha256-..'".
std::string hashes(std::string_view page, std::string_view open, std::string_view close) {
  std::string words;
  for (std::size_t at = page.find(open); at != std::string_view::npos; at = page.find(open, at)) {
    at += open.size();
    const std::size_t end = page.find(close, at);
    const auto digest = from_hex(sha256_of_text(std::string(page.substr(at, end - at))));
    words += fmt::format("{}'sha256-{}'", words.empty() ? "" : " ", base64(digest));
  }
  return words;
}

/// The page with its slots filled. They are looked for in the page itself and never in what fills them.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& slots) {
  std::string text;
  for (const auto& [slot, words] : slots) {
    const auto at = page.find(slot);
    if (at == std::string_view::npos) throw std::logic_error("the page has no " + std::string(slot));
    text += std::string(page.substr(0, at)) + words;
    page.remove_prefix(at + slot.size());
  }
  return text + std::string(page);
}

/// Texts that name files, as a page may say them that is sent on.
void leave_out_folders(Json& json) {
  if (json.is_string()) json = without_absolute_paths(json.get<std::string>());
  if (!json.is_structured()) return;
  for (Json& item : json) leave_out_folders(item);
}

}  // namespace

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
  const std::string_view page = page_template();
  return filled(page, {{"@HASHES_OF_SCRIPTS@", hashes(page, "<script>", "</script>")},
                       {"@HASHES_OF_STYLES@", hashes(page, "<style>", "</style>")},
                       {"@TITLE@", for_html(input.run.summary.title)},
                       {"@DATA@", for_script(data)}});
}

}  // namespace talus::postprocess
