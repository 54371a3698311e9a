// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/inflow.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "solver/options/output.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

void describe_line(recipe::Visitor& v, InflowOptions& o, const std::string& shown) {
  v.pairs("line_m", o.line, recipe::any,
          "map coordinates of the two ends of the line that material enters through: [[east, north], [east, north]]");
  v.text("place", o.place,
         "instead: [[preprocess.place]] of this name; its line called name, or the only one that it has");
  v.needs(!o.place.empty() || o.line.size() == 2,
          {fmt::format("{}: line_m has {} points", shown, o.line.size()),
           "it enters through a straight line between two points",
           "Give line_m = [[x, y], [x, y]], or place = \"...\" for a line of a vector file"});
  v.needs(o.place.empty() || o.line.empty(), {fmt::format("{} has place = \"{}\" beside line_m", shown, o.place),
                                              "either says where it enters", "Leave one of them out"});
  v.needs(o.line.size() != 2 || o.line[0] != o.line[1],
          {shown + ": both ends of the line are one point", "a line of no length lets nothing through",
           "Move one of them"});
}

/// Declares the hydrograph: a file, or its rows.
void describe_hydrograph(recipe::Visitor& v, InflowOptions& o, const std::string& shown) {
  v.path("file", o.file, "table of time_s and discharge_m3_s (docs/reference/formats.md); or hydrograph");
  v.pairs("hydrograph", o.hydrograph, recipe::not_negative,
          "[[time in s, discharge in m3/s], ...] without a file: times growing, straight lines between; nothing before "
          "the first and after the last");
  v.needs(o.file.empty() != o.hydrograph.empty(),
          {shown + (o.file.empty() ? ": neither file nor hydrograph is given" : ": file beside hydrograph"),
           "the discharge is by one or the other", "Give one of them"});
  v.needs(o.hydrograph.size() != 1, {shown + ": hydrograph has one row", "it has two at least",
                                     "Give a constant discharge as two rows: hydrograph = [[0, 10], [60, 10]]"});
  const auto late = std::adjacent_find(o.hydrograph.begin(), o.hydrograph.end(),
                                       [](const auto& a, const auto& b) { return !(b[0] > a[0]); });
  v.needs(late == o.hydrograph.end(),
          {late == o.hydrograph.end()
               ? std::string()
               : fmt::format("{}: hydrograph has time {:g} before {:g}", shown, (*late)[0], (*(late + 1))[0]),
           "times must grow from row to row", "Sort the rows; a jump is two rows a moment apart"});
  v.number("scale", o.scale, recipe::positive, "factor of the discharges");
}

/// Declares how fast the material enters, and which way.
void describe_motion(recipe::Visitor& v, InflowOptions& o, const std::string& shown) {
  const recipe::Range speeds{0, 100, true, false};
  v.optional_number("speed_m_s", o.speed, speeds, "speed along the ground; the depth follows from the discharge");
  v.optional_number("depth_m", o.depth, recipe::positive,
                    "thickness where it is deepest (vertical); the speed follows from the discharge");
  v.optional_number("froude", o.froude, recipe::Range{0, 20, true, false},
                    "Froude number; speed and depth follow from the discharge");
  const int given = (o.speed ? 1 : 0) + (o.depth ? 1 : 0) + (o.froude ? 1 : 0);
  v.needs(given == 1, {fmt::format("{}: {} of speed_m_s, depth_m and froude are given", shown, given),
                       "a discharge does not say how fast and how deep it is", "Give exactly one of them"});
  v.optional_number("azimuth_deg", o.azimuth, recipe::Range{-360, 360},
                    "direction of the flow, from north over east; left out: across the line, downhill");
  v.integers("points_per_cell", o.points_per_cell, recipe::Range{1, 64},
             "material points along the flow, across it and in height");
  v.needs(o.points_per_cell.size() == 3,
          {fmt::format("{}: points_per_cell has {} values", shown, o.points_per_cell.size()),
           "it is one number along the flow, one across it, one in height", "The usual is [2, 2, 2]"});
}

}  // namespace

void InflowOptions::describe(recipe::Visitor& v, const std::string& shown, const SolveOptions& all) {
  v.text("name", name, "under which its material is recorded, and [[solve.part]] knows it; empty = inflow-1, ...");
  describe_line(v, *this, shown);
  describe_hydrograph(v, *this, shown);
  describe_motion(v, *this, shown);
  v.needs(abilities_of(all.asked_integrator()).carry_inertia,
          {shown + " does not go with integrator = \"quasi-static\"",
           "what enters has a speed, which a sequence of equilibria leaves out",
           "Take integrator = \"auto\", \"explicit\", \"column-implicit\" or \"newmark\""});
  v.needs(!all.stability.factor_of_safety, {shown + " does not go with [solve.stability] factor_of_safety = true",
                                            "a factor of safety is that of a mass at rest", "Leave one of them out"});
}

std::string inflow_name(const InflowOptions& options, std::size_t number) {
  return options.name.empty() ? fmt::format("inflow-{}", number + 1) : options.name;
}

void describe_inflows(recipe::Visitor& v, std::vector<InflowOptions>& inflows, const SolveOptions& all) {
  recipe::list(v, "inflow", inflows, "material that enters through a line over time, by a hydrograph",
               [&](InflowOptions& inflow, std::size_t item) {
                 inflow.describe(v, fmt::format("[[solve.inflow]] number {}", item + 1), all);
               });
  std::vector<std::optional<std::string>> names;
  for (std::size_t n = 0; n < inflows.size(); ++n) {
    const bool named = !inflows[n].name.empty() || inflows[n].place.empty();
    names.push_back(named ? std::optional(inflow_name(inflows[n], n)) : std::nullopt);
  }
  need_names(v, "inflow", "its material is recorded under its name", names);
}

}  // namespace talus::solver
