// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an authority asks, for the report: the table of buildings, and the largest of what sections and gauges saw.
#include <algorithm>
#include <cmath>

#include "postprocess/hazard/hazard.hpp"
#include "postprocess/report/parts.hpp"

namespace talus::postprocess {
namespace {

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json building_json(const Building& b) {
  return {{"name", b.name},
          {"arrival", number_or_null(b.arrival)},
          {"thickness", {b.thickness.largest, b.thickness.p99}},
          {"speed", {b.speed.largest, b.speed.p99}},
          {"pressure", {b.pressure.largest, b.pressure.p99}},
          {"width", b.width},
          {"force", b.force},
          {"force_from", source_word(b.source)}};
}

/// The largest of a column of a place and when it was; of a running sum the last.
Json place_json(const RunHistory& history, const HistoryColumn& column) {
  const std::vector<double>& time = history.at("time_s").values;
  std::size_t at = 0;
  for (std::size_t row = 0; row < column.values.size(); ++row) {
    if (std::abs(column.values[row]) > std::abs(column.values[at])) at = row;
  }
  return {{"place", column.place},
          {"quantity", column.quantity},
          {"unit", column.unit},
          {"largest", column.values.empty() ? Json() : number_or_null(column.values[at])},
          {"time", column.values.empty() ? Json() : Json(time[at])}};
}

}  // namespace

Json hazard_json(const ReportInput& input) {
  Json json{{"buildings", Json::array()}, {"places", Json::array()}};
  if (input.hazard != nullptr)
    for (const Building& b : input.hazard->buildings) json["buildings"].push_back(building_json(b));
  for (const HistoryColumn& column : input.run.history.columns)
    if (column.place.starts_with("gauge ") || column.place.starts_with("section "))
      json["places"].push_back(place_json(input.run.history, column));
  return json;
}

}  // namespace talus::postprocess
