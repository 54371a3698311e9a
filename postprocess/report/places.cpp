// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges and obstacles of the report.
#include "common/run/places.hpp"

#include <algorithm>
#include <cmath>

#include "postprocess/report/parts.hpp"

namespace talus::postprocess {
namespace {

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

}  // namespace

Json places_json(const ReportInput& input) {
  auto list = Json::array();
  const Window window = shown_window(input);
  for (const MapPlace& place : places_in(input.run.summary.provenance)) {
    auto rings = Json::array();
    for (const auto& ring : place.rings) {
      auto flat = Json::array();
      for (const auto& [x, y] : ring) {
        flat.push_back(std::round(100 * (x - window.west)) / 100);
        flat.push_back(std::round(100 * (y - window.south)) / 100);
      }
      rings.push_back(std::move(flat));
    }
    const auto space = place.words.find(' ');
    list.push_back({{"kind", place.words.substr(0, space)},
                    {"name", space == std::string::npos ? place.words : place.words.substr(space + 1)},
                    {"rings", std::move(rings)},
                    {"measured", extremes_at(place.words, input.run.history)}});
  }
  return list;
}

}  // namespace talus::postprocess
