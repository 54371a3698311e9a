// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace talus::validation {
namespace {

std::string number(double value, const char* format = "{:.5g}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

using Cells = std::array<std::string, 13>;

const Cells header{"case",   "quantity", "computed", "wanted", "error",  "pass", "wall [s]",
                   "points", "steps",    "Newton",   "CG",     "dt/CFL", "place"};

/// What passes: a reference with its tolerance, a band, or the end of one.
std::string wanted(const Row& r) {
  if (!r.judged) return "-";
  if (!std::isfinite(r.lowest) || (r.reference == 0 && r.tolerance > 0)) return "<= " + number(r.highest + r.tolerance);
  if (!std::isfinite(r.highest)) return ">= " + number(r.lowest);
  const std::string tolerance = r.tolerance > 0 ? fmt::format(" +- {:.2g} %", 100 * r.tolerance) : "";
  return (r.lowest < r.highest ? number(r.lowest) + " to " + number(r.highest) : number(r.reference)) + tolerance;
}

std::string verdict(const Row& r) {
  if (!r.fault.empty()) return "FAILED";
  return !r.judged ? "noted" : r.pass ? "yes" : "NO";
}

std::string shortened(const std::string& place) { return place.size() <= 28 ? place : place.substr(0, 27) + "~"; }

Cells cells_of(const Row& r) {
  return {r.name,
          r.quantity,
          number(r.computed),
          wanted(r),
          number(r.error, "{:.2e}"),
          verdict(r),
          number(r.wall_time, "{:.2f}"),
          number(r.particles, "{:.0f}"),
          number(r.steps, "{:.0f}"),
          number(r.newton, "{:.0f}"),
          number(r.cg, "{:.0f}"),
          number(r.over_cfl, "{:.2g}"),
          shortened(r.place)};
}

/// Columns of length in characters, not bytes: hardware names may hold others than ASCII.
std::string line_of(const Cells& cells, const std::array<std::size_t, 13>& widths) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const bool text = c < 2 || c + 1 == cells.size();
    line += fmt::format(fmt::runtime(text ? "{:<{}}  " : "{:>{}}  "), cells[c], widths[c]);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

nlohmann::ordered_json plain(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

Counts count(const std::vector<Row>& rows) {
  Counts c;
  for (const Row& r : rows) {
    (r.judged ? c.judged : c.noted) += 1;
    if (r.failed()) (r.judged ? c.missed : c.lost) += 1;
  }
  return c;
}

std::string as_table(const std::vector<Row>& rows) {
  std::vector<Cells> lines{header};
  for (const Row& row : rows) lines.push_back(cells_of(row));
  std::array<std::size_t, 13> widths{};
  for (const Cells& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const Cells& line : lines) text += line_of(line, widths);
  std::string last;
  for (const Row& row : rows) {
    if (row.fault.empty() || row.name == last) continue;
    last = row.name;
    text += fmt::format("{}: {}\n", row.name, row.fault);
  }
  const Counts c = count(rows);
  return text + fmt::format("{} rows: {} judged, of which {} failed; {} noted, of which {} without a result\n",
                            rows.size(), c.judged, c.missed, c.noted, c.lost);
}

std::string as_json(const Sitting& sitting, const std::vector<Row>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const Row& r : rows) {
    nlohmann::ordered_json row{
        {"case", r.name}, {"quantity", r.quantity}, {"judged", r.judged}, {"computed", plain(r.computed)}};
    if (r.judged) {
      row["reference"] = plain(r.reference);
      row["error"] = plain(r.error);
      row["tolerance"] = plain(r.tolerance);
      row["lowest"] = plain(r.lowest);
      row["highest"] = plain(r.highest);
      row["pass"] = r.pass;
    }
    row["wall_time_s"] = plain(r.wall_time);
    row["particles"] = plain(r.particles);
    row["steps"] = plain(r.steps);
    row["newton"] = plain(r.newton);
    row["cg"] = plain(r.cg);
    row["dt_over_cfl"] = plain(r.over_cfl);
    row["place"] = r.place;
    if (!r.fault.empty()) row["fault"] = r.fault;
    list.push_back(std::move(row));
  }
  const nlohmann::ordered_json all{{"commit", sitting.commit},     {"date", sitting.date},     {"on", sitting.on},
                                   {"complete", sitting.complete}, {"coarse", sitting.coarse}, {"cases", sitting.cases},
                                   {"rows", std::move(list)}};
  return all.dump(1) + "\n";
}

}  // namespace talus::validation
