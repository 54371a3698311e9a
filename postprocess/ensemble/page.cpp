// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/results.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/gis/crs.hpp"

namespace talus::postprocess {
namespace {

/// The members at the edge of their domain: their names where they are few, else how many they are.
std::string names_at_edge(const Ensemble& ensemble, const std::vector<std::int64_t>& members) {
  constexpr std::size_t few = 12;
  if (members.size() <= few) return ensemble.table.names_of(members, few);
  return fmt::format("{} of {} {}", members.size(), ensemble.counted(), ensemble.table.slides ? "slides" : "members");
}

constexpr std::size_t words_on_page = 50, steps_of_convergence = 160, medoids_wanted = 4;

/// Of which footprints are compared, each with each.
constexpr std::size_t members_compared = 400;

/// The first of what is said of members that are not left out.
Json words_json(const Ensemble& ensemble, const std::vector<MemberWords>& list) {
  auto json = Json::array();
  for (const MemberWords& one : list)
    if (json.size() < words_on_page && ensemble.counts.state_of(one.member) != MemberState::left_out)
      json.push_back({ensemble.table.name_of(one.member), one.words});
  return json;
}

/// Whether members are draws of one thing, and neither slides nor single changes.
bool is_sample(const Ensemble& ensemble) { return ensemble.table.names.empty(); }

Json share_scores_json(const MemberRows& rows) {
  auto list = Json::array();
  for (const ShareScore& one : rows.share_scores)
    list.push_back({{"of", one.of}, {"held", one.held}, {"csi", one.csi}, {"brier", one.brier}});
  return list;
}

void add_warnings(const Ensemble& ensemble, Json& json) {
  json["warnings"] = Json::array();
  std::vector<MemberWords> of_members;
  std::set<std::int64_t> warned;
  for (const Finding& f : ensemble.counts.findings) {
    if (f.severity != Severity::warning) continue;
    if (f.member == Finding::no_member) json["warnings"].push_back(f.message);
    if (f.member != Finding::no_member) of_members.push_back({f.member, f.message}), warned.insert(f.member);
  }
  json["warnings_of_members"] = words_json(ensemble, of_members);
  json["warnings_in_all"] = of_members.size();
  json["members_warned"] = warned.size();
}

Json run_json(const EnsemblePageInput& input) {
  const Ensemble& ensemble = input.ensemble;
  const EnsembleCounts& counts = ensemble.counts;
  const ShareWords words = share_words(ensemble.table.design);
  Json json{
      {"title", counts.scene.title}, {"scene", counts.scene.scene}, {"version", version()}, {"run_version", version()}};
  json["made"] = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  json["institution"] = input.options.institution;
  json["crs"] = crs_name(counts.scene.grid.crs_wkt);
  json["grid"] = {
      {"columns", counts.scene.grid.columns}, {"rows", counts.scene.grid.rows}, {"cell", counts.scene.grid.cell}};
  json["threshold"] = counts.scene.threshold;
  json["design"] = ensemble.table.design;
  json["seed"] = ensemble.table.seed;
  json["members"] = counts.members;
  json["counted"] = ensemble.counted();
  json["failed"] = ensemble.failed();
  json["waiting"] = ensemble.waiting();
  json["draws"] = independent_draws(ensemble.table, ensemble.counted());
  json["share"] = {
      {"meaning", words.meaning}, {"error", words.error}, {"is_probability", is_probability(ensemble.table.design)}};
  const auto rule = hazard_rule(ensemble, input.options.hazard);
  json["hazard"] = rule ? Json(hazard_words(*rule)) : Json();
  json["survey"] = input.survey ? Json(input.survey->name) : Json();
  json["share_scores"] = share_scores_json(input.rows);
  json["slides"] = ensemble.table.slides.has_value();
  json["sampled"] = is_sample(ensemble);
  const std::vector<std::int64_t> at_edge = counts.at_edge();
  json["at_edge"] = at_edge.empty() ? Json() : Json(names_at_edge(ensemble, at_edge));
  json["prior"] = fact(ensemble.table.provenance, prior_of_members);
  json["elevation_error"] = fact(ensemble.table.provenance, elevation_error_of_members);
  json["accepted"] = Json::array();
  for (const Finding& f : insisted_on(ensemble)) json["accepted"].push_back({f.name, f.message});
  add_warnings(ensemble, json);
  json["failures"] = words_json(ensemble, counts.failures);
  return json;
}

/// Six figures are more than a chart shows.
Json rounded_list(const std::vector<double>& values, std::size_t count) {
  auto list = Json::array();
  for (std::size_t k = 0; k < count; ++k)
    list.push_back(std::isfinite(values[k]) ? Json(std::stod(fmt::format("{:.6g}", values[k]))) : Json());
  return list;
}

Json members_json(const MemberRows& rows) {
  constexpr const char* kinds[] = {"input", "result", "score"};
  const std::size_t shown = std::min(rows.states.size(), members_on_page);
  Json json{{"all", rows.states.size()}, {"shown", shown}, {"states", Json::array()}, {"columns", Json::array()}};
  for (std::size_t k = 0; k < shown; ++k) json["states"].push_back(static_cast<int>(rows.states[k]));
  for (const RowColumn& column : rows.columns)
    json["columns"].push_back({{"name", column.name},
                               {"unit", column.unit},
                               {"title", column.title},
                               {"kind", kinds[static_cast<std::size_t>(column.kind)]},
                               {"words", column.words},
                               {"values", rounded_list(column.values, shown)}});
  return json;
}

Json sensitivity_json(const EnsemblePageInput& input) {
  auto list = Json::array();
  for (const auto& [name, found] : input.sensitivity) {
    auto indices = Json::array();
    for (const SensitivityIndex& index : found.indices)
      indices.push_back({{"key", index.key},
                         {"measure", measure_words(index.measure).name},
                         {"title", measure_words(index.measure).title},
                         {"value", index.value},
                         {"low", std::isfinite(index.low) ? Json(index.low) : Json()},
                         {"high", std::isfinite(index.high) ? Json(index.high) : Json()}});
    list.push_back({{"result", name}, {"members", found.members}, {"note", found.note}, {"indices", indices}});
  }
  return list;
}

Json convergence_json(const MemberRows& rows) {
  auto list = Json::array();
  for (const RowColumn& column : rows.columns) {
    if (!has_sensitivity(column)) continue;
    const Convergence steps = convergence(column.values, steps_of_convergence);
    list.push_back({{"name", column.name},
                    {"members", steps.members},
                    {"mean", rounded_list(steps.mean, steps.mean.size())},
                    {"error", rounded_list(steps.error, steps.error.size())}});
  }
  return list;
}

Json medoids_json(const Ensemble& ensemble) {
  const Medoids found = medoids(ensemble.counts, medoids_wanted, members_compared);
  std::int64_t of = 0;
  for (const std::int64_t count : found.counts) of += count;
  return {{"members", found.members}, {"counts", found.counts}, {"of", of}, {"mean_distance", found.mean_distance}};
}

/// The part of the map that is shown: all that any member reached, released or surveyed.
Window ensemble_window(const EnsemblePageInput& input) {
  const EnsembleCounts& counts = input.ensemble.counts;
  RunMaps maps = base_maps(counts.scene);
  const std::vector<std::uint32_t> reached = counts.cells.spread(counts.maps[0].reached, 0u);
  for (std::size_t cell = 0; cell < reached.size(); ++cell)
    maps.peak_thickness[cell] = reached[cell] > 0 ? 2 * input.options.footprint_threshold : 0;
  return page_window(maps, input.options, input.survey);
}

/// What the page of an ensemble or of a budget has of maps and outlines.
PageParts ensemble_page_parts(const EnsemblePageInput& input) {
  const Window window = ensemble_window(input);
  const MapGrid& grid = input.ensemble.counts.scene.grid;
  const MapGrid shown = cut({grid, std::vector<double>(grid.count(), 0.0)}, window).grid;
  return {ensemble_maps_json(input, window), ensemble_outlines_json(input, window, shown),
          is_sample(input.ensemble) ? medoids_json(input.ensemble) : no_medoids()};
}

}  // namespace

Json no_medoids() { return {{"members", Json::array()}, {"counts", Json::array()}, {"of", 0}, {"mean_distance", 0}}; }

std::string ensemble_html(const EnsemblePageInput& input) {
  PageParts parts = input.ensemble.table.slides ? slide_page_parts(input) : ensemble_page_parts(input);
  Json data;
  data["run"] = run_json(input);
  data["map"] = std::move(parts.map);
  data["outlines"] = std::move(parts.outlines);
  data["medoids"] = std::move(parts.medoids);
  data["members"] = members_json(input.rows);
  data["sensitivity"] = sensitivity_json(input);
  data["convergence"] = is_sample(input.ensemble) ? convergence_json(input.rows) : Json::array();
  data["budget"] = input.budget == nullptr ? Json() : budget_json(*input.budget);
  data["calibration"] = input.calibration;
  data["stages"] = stages_json(input.stages);
  for (const char* part : {"run", "stages", "budget"}) leave_out_folders(data[part]);
  return filled_page(ensemble_template(),
                     input.ensemble.counts.scene.title + (input.ensemble.table.slides ? ": slides"
                                                          : input.budget != nullptr   ? ": error budget"
                                                                                      : ": ensemble"),
                     data);
}

}  // namespace talus::postprocess
