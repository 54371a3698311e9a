// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/output.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "common/domain/domain_place.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

void need_names(recipe::Visitor& v, const std::string& table, const std::string& why,
                const std::vector<std::optional<std::string>>& names) {
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (!names[n]) continue;
    const std::string& name = *names[n];
    const bool plain = is_plain_name(name);
    v.needs(plain, {fmt::format("[[solve.{}]] number {}: name = \"{}\"", table, n + 1, name), why,
                    "Give it one of letters, digits, - and _"});
    for (std::size_t earlier = 0; earlier < n; ++earlier)
      v.needs(!plain || names[earlier] != name,
              {fmt::format("[[solve.{}]] name = \"{}\" is given twice", table, name), why, "Rename one"});
  }
}

void GaugeOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "under which its readings are recorded");
  recipe::fixed_list<double>(v, "at_m", {&x, &y}, recipe::any, "map coordinates: east, north", "[[solve.gauge]]");
  v.text("place", place,
         "instead: [[preprocess.place]] of this name; its point called name, or every point under its own");
  v.needs(place.empty() || (x == 0 && y == 0),
          {fmt::format("[[solve.gauge]] name = \"{}\" has place = \"{}\" beside at_m", name, place),
           "either says where it is", "Leave one of them out"});
}

void SectionOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "under which its numbers are recorded");
  v.pairs("line_m", line, recipe::any,
          "map coordinates of its points, [[east, north], ...]; what crosses from left to right along them counts up");
  v.text("place", place,
         "instead: [[preprocess.place]] of this name; its line called name, or every line under its own");
  const std::string which = fmt::format("[[solve.section]] name = \"{}\"", name);
  v.needs(!place.empty() || line.size() >= 2,
          {fmt::format("{}: line_m has {} points", which, line.size()), "a section is a line of two or more points",
           "Give line_m = [[x, y], [x, y]], or place = \"...\" for lines of a vector file"});
  v.needs(place.empty() || line.empty(), {fmt::format("{} has place = \"{}\" beside line_m", which, place),
                                          "either says where it is", "Leave one of them out"});
  v.needs(std::adjacent_find(line.begin(), line.end()) == line.end(),
          {which + " gives a point twice, one after the other", "a piece of the line would have no length",
           "Leave one of them out"});
}

void OutputOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  const StepAbilities steps = abilities_of(all.asked_integrator());
  v.number("frame_interval_s", frame_interval, recipe::positive, "time between frames");
  v.number("history_interval_s", history_interval, recipe::positive, "time between records of energy and mass");
  v.number("checkpoint_interval_s", checkpoint_interval, recipe::not_negative,
           "simulated time between checkpoints; 0: only when interrupted");
  v.optional_number("map_threshold_m", map_threshold, recipe::positive,
                    "thickness from which cells count: for speed, pressure, arrival, run-out and areas; not given: 0.1 "
                    "m, or 5 % of the median released thickness where that is less");
  recipe::choice(
      v, "point_frames", point_frames,
      {{"rounded", FramePoints::rounded}, {"exact", FramePoints::exact}, {"none", FramePoints::none}},
      "material points of frames in run.h5; rounded: positions to 1e-4 of a cell, velocity and pressure to 1e-4; the "
      "file is half as large");
  v.flag("energy_budget", energy_budget,
         "explicit and column-implicit steps: keep what is lost to the bed, to plastic flow, to damping and between "
         "points and grid, and "
         "the impulse of bed and walls (two to three times as slow on a GPU)");
  v.needs(!energy_budget || (steps.count_losses && all.stress_update == StressUpdate::last),
          {"[solve] energy_budget = true does not go with this integrator or stress_update",
           "losses are counted in explicit and column-implicit steps with stress_update = \"usl\"",
           "Leave it out, or take integrator = \"explicit\""});
  v.needs(!energy_budget || all.obstacles.empty(),
          {"[[solve.obstacle]] does not go with energy_budget = true", "what is lost between nodes is not counted",
           "Leave energy_budget out"});
  v.flag("deterministic", deterministic,
         "explicit and column-implicit steps: the same bits on every run on a GPU too, as on the CPU always (slower)");
  v.needs(!deterministic || (steps.repeat_bits && !energy_budget),
          {"[solve] deterministic = true does not go with this integrator or with energy_budget",
           "sums of implicit steps and of the budget are made in any order on a GPU",
           "Leave it out, or take integrator = \"explicit\" without energy_budget"});
  v.names("accept", accept, {std::begin(acceptable), std::end(acceptable)},
          "what is refused because it is hardly ever right, and here is; it goes with all results");
  recipe::list(v, "gauge", gauges, "points where thickness, speed and surface are recorded over time");
  need_names(v, "gauge", "its readings are recorded under its name", gauges);
  recipe::list(v, "section", sections, "lines on the map: what crosses them is recorded over time");
  need_names(v, "section", "its numbers are recorded under its name", sections);
}

}  // namespace talus::solver
