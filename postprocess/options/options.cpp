// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/options/options.hpp"

#include <chrono>
#include <regex>

namespace talus::postprocess {
namespace {

/// "1903-04-29 04:10:00", after the calendar reform of 1582, before which calendars differ.
bool is_date(const std::string& text) {
  static const std::regex form(R"((\d{4})-(\d\d)-(\d\d) (\d\d):(\d\d):(\d\d))");
  std::smatch part;
  if (!std::regex_match(text, part, form)) return false;
  const auto number = [&](int i) { return std::stoi(part[static_cast<std::size_t>(i)]); };
  const auto unsigned_number = [&](int i) { return static_cast<unsigned>(number(i)); };
  const std::chrono::year_month_day day{std::chrono::year{number(1)}, std::chrono::month{unsigned_number(2)},
                                        std::chrono::day{unsigned_number(3)}};
  return day.ok() && number(1) > 1582 && number(4) < 24 && number(5) < 60 && number(6) < 60;
}

}  // namespace

bool Options::writes(std::string_view word) const { return std::ranges::find(outputs, word) != outputs.end(); }

void Options::settle_thresholds(double of_run) {
  footprint_threshold = given.footprint_threshold.value_or(of_run);
  deposit_threshold = given.deposit_threshold.value_or(of_run);
}

void Options::describe(recipe::Visitor& v) {
  v.path("run", run, "run.h5 of talus-solve; empty: the one in the output folder");
  v.optional_number("footprint_threshold_m", given.footprint_threshold, recipe::positive,
                    "footprint: peak thickness above this; not given: map_threshold_m of the run (0.1 m, or 5 % of the "
                    "median release where that is less)");
  v.optional_number("deposit_threshold_m", given.deposit_threshold, recipe::positive,
                    "deposit and run-out: final thickness above this; not given: the same");
  v.numbers("classes_m", classes, recipe::positive,
            "lower limits of the map's thickness classes, rising; empty: four to six of 0.1 0.5 1 2 5 10 25 50 100 200 "
            "500 that "
            "fit the thickest, and finer ones below them where it is thin");
  need_classes(v, "[postprocess] classes_m", classes);
  recipe::choice(v, "friction_is", friction_is,
                 {{"not-said", FrictionIs::not_said},
                  {"given", FrictionIs::given},
                  {"guessed", FrictionIs::guessed},
                  {"fitted", FrictionIs::fitted}},
                 "where the friction comes from, for the first lines of report, scores and map: given (measured, or "
                 "from other events), guessed, or fitted to this event");
  v.names("accept", accept, {"change-outside-slide", "swapped-surveys", "different-vertical-datums"},
          "what is refused because it is hardly ever right, and here is; it goes with all results");
  v.text("institution", institution, "who made this, for the NetCDF file");
  v.text("start_time", start_time,
         "when the failure began, UTC, as 1903-04-29 04:10:00, for the time axis of the NetCDF file; empty: not known");
  v.needs(start_time.empty() || is_date(start_time), {"[postprocess] start_time = \"" + start_time + "\"",
                                                      "this is no date and time", "Write it as 1903-04-29 04:10:00"});
  v.path("thalweg", thalweg,
         "line along which run-out is measured (any vector format), from either end; empty: found as the path of the "
         "centre of mass");
  v.names(
      "outputs", outputs, output_words(),
      "what is written besides maps, tables and scores: report.html, with a view in 3-D (report-3d); surface, terrain "
      "and points over time for ParaView (3d/); a film (mp4, gif; needs ffmpeg); peaks as AvaFrame names them "
      "(avaframe-tif, avaframe-asc)");
  recipe::table(
      v, "survey", survey,
      "what the run is scored against: thickness, or difference, or after_dem, or polygon; all empty: no scores");
  recipe::table(v, "intensity", intensity, "classes of intensity, by a guideline or own limits");
  recipe::table(v, "reach_cone", reach_cone, "a second opinion: what an angle of reach (Fahrboeschung) reaches");
  recipe::table(v, "buildings", buildings, "what comes to each building");
  recipe::table(v, "hazard", hazard, "of an ensemble: classes by how probable it is to be hit how hard");
}

}  // namespace talus::postprocess
