// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of buildings of the report.
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

}  // namespace

Json hazard_json(const ReportInput& input) {
  Json json{{"buildings", Json::array()}};
  if (input.hazard != nullptr)
    for (const Building& b : input.hazard->buildings) json["buildings"].push_back(building_json(b));
  return json;
}

}  // namespace talus::postprocess
