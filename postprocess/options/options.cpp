// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/options/options.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <regex>
#include <utility>

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

/// This function declares that the survey gives one deposit at most.
void need_one_deposit(recipe::Visitor& v, const SurveyOptions& s) {
  const std::pair<bool, const char*> deposits[] = {{!s.thickness.empty(), "thickness"},
                                                   {!s.difference.empty(), "difference"},
                                                   {!s.after_dem.empty(), "after_dem"},
                                                   {s.from_preprocess, "from_preprocess"}};
  std::string keys;
  int count = 0;
  for (const auto& [given, key] : deposits) {
    if (given) keys += (count++ > 0 ? " and " : "") + std::string(key);
  }
  v.needs(count <= 1,
          {"[postprocess.survey] gives " + keys, "one deposit can be scored at a time", "Leave one of them out"});
}

/// This function declares that the survey gives one error at most, and that of something measured.
void need_one_error(recipe::Visitor& v, const SurveyOptions& s) {
  const bool given = !s.sigma.empty() || s.sigma_m > 0;
  v.needs(s.sigma.empty() || !(s.sigma_m > 0), {"[postprocess.survey] gives sigma and sigma_m",
                                                "both say what the survey's error is", "Leave one of them out"});
  v.needs(!given || !s.from_preprocess, {"[postprocess.survey] gives from_preprocess and an error",
                                         "the error comes with the change that talus-preprocess found",
                                         "Leave sigma out; [preprocess.difference] takes the surveys' own"});
  v.needs(!given || s.from_preprocess || s.measures(),
          {"[postprocess.survey] gives an error without a measurement", "an outline or a peak thickness has none",
           "Give thickness, difference or after_dem, or leave sigma out"});
}

/// This function declares that the limits of the classes rise, and that a map can show so many.
void need_classes(recipe::Visitor& v, const std::vector<double>& classes) {
  v.needs(std::adjacent_find(classes.begin(), classes.end(), std::greater_equal<>()) == classes.end(),
          {"[postprocess] classes_m does not rise", "classes are given by their lower limits",
           "Sort the limits, each once"});
  v.needs(classes.size() <= 9, {"[postprocess] classes_m has " + std::to_string(classes.size()) + " classes",
                                "nobody tells more than 9 shades apart on a map", "Give 9 limits or fewer"});
}

}  // namespace

void SurveyOptions::name_files(const std::filesystem::path& out) {
  if (!from_preprocess) return;
  difference = out / "survey" / "slide_difference.tif";
  sigma = out / "survey" / "difference_sigma.tif";
}

void SurveyOptions::find_in(const std::filesystem::path& out, bool error_known) {
  name_files(out);
  if (!from_preprocess) return;
  if (!error_known) sigma.clear();
  for (const auto& file : {difference, sigma}) {
    if (!file.empty() && !std::filesystem::exists(file))
      throw DataError({file.string() + ": no such file",
                       "[postprocess.survey] from_preprocess = true, and talus-preprocess writes it where before_dem "
                       "and after_dem are given",
                       "Run talus-preprocess with the same --out, or name the survey otherwise"});
  }
}

void SurveyOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "how map and table call it: a survey, or another model's name");
  recipe::choice(v, "kind", kind, {{"survey", ReferenceKind::survey}, {"model", ReferenceKind::model}},
                 "what it is: a survey, or the run of another model, which report and table then do not call surveyed");
  v.needs(kind == ReferenceKind::survey || name != "survey",
          {"[postprocess.survey] gives kind = \"model\" without a name", "maps and tables would call it a survey",
           "Name the other model: name = \"SHALTOP, 15 degrees\""});
  v.path("thickness", thickness, "raster of the deposit's thickness [m]");
  v.path("peak_thickness", peak_thickness, "raster of the peak thickness [m]; gives the footprint");
  recipe::choice(v, "direction", direction,
                 {{"vertical", Direction::vertical}, {"slope-normal", Direction::slope_normal}},
                 "which way these two measure thickness; slope-normal: brought to vertical with the run's ground");
  v.path("after_dem", after_dem, "elevations after the event: deposit where they lie above those before");
  v.path("before_dem", before_dem,
         "elevations before the event, with after_dem; empty: the surface the run started from");
  v.needs(before_dem.empty() || !after_dem.empty(),
          {"[postprocess.survey] gives before_dem alone", "a change needs two surfaces", "Give after_dem as well"});
  v.path("difference", difference,
         "raster of elevations after - before the event [m], aligned: deposit where it is positive");
  v.flag("from_preprocess", from_preprocess,
         "score against the change of surface that talus-preprocess found between before_dem and after_dem, with its "
         "error (OUT/survey)");
  need_one_deposit(v, *this);
  v.path("polygon", polygon, "outline of the affected area (any vector format); gives the footprint");
  v.needs(peak_thickness.empty() || polygon.empty(), {"[postprocess.survey] gives peak_thickness and polygon",
                                                      "both say what the footprint is", "Leave one of them out"});
  v.flag("nodata_is_zero", nodata_is_zero,
         "thickness and difference rasters: no data means no deposit (otherwise: not surveyed, left out)");
  v.needs(kind == ReferenceKind::survey || (sigma.empty() && !(sigma_m > 0) && !from_preprocess),
          {"[postprocess.survey] gives kind = \"model\" and the error of a survey",
           "what another model computed has no error of measurement", "Leave sigma and from_preprocess out, or kind"});
  v.path("sigma", sigma, "raster of the standard error (1 sigma) of thickness or change [m]");
  v.number("sigma_m", sigma_m, recipe::not_negative, "the same error for all cells, instead of a raster; 0: not known");
  need_one_error(v, *this);
  v.number(
      "correlation_length_m", correlation_length, recipe::not_negative,
      "distance within which errors are alike (range of a spherical variogram); 0: CORRELATION_LENGTH_M of the sigma "
      "raster, else every cell for itself");
  v.number("detection", detection, recipe::not_negative,
           "with a sigma: thickness or change below this times sigma counts as none (1.96: 95 %); 0: off");
  v.integer("resamples", resamples, {0, 100000},
            "with a sigma: surveys drawn within their error, for the spread of the scores; 0: none");
}

void HazardOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "intensity", intensity,
                 {{"peak-pressure", HazardIntensity::peak_pressure},
                  {"peak-thickness", HazardIntensity::peak_thickness},
                  {"peak-speed", HazardIntensity::peak_speed}},
                 "the map by which the intensity of a hazard goes");
  v.numbers("limits", limits, recipe::positive,
            "lower limits of the classes of intensity, rising, in kPa, m or m/s; they must be among those of "
            "[ensemble.thresholds]; empty: 3 30 kPa, 0.5 1 m, 0.5 1 m/s where they are");
  v.numbers("probability", probability, recipe::fraction, "lower limits of the classes of probability, rising");
  v.integers("matrix", matrix, {0, 9},
             "hazard class of each intensity (from weak) and probability (from rare), row by row; 0: none");
  const auto rises = [](const std::vector<double>& values) {
    return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  };
  v.needs(rises(limits) && rises(probability) && !probability.empty(),
          {"[postprocess.hazard] limits or probability do not rise", "classes are given by their lower limits",
           "Sort them, each once"});
  const std::size_t rows = limits.empty() ? 2 : limits.size();
  v.needs(matrix.size() == rows * probability.size(),
          {"[postprocess.hazard] matrix has " + std::to_string(matrix.size()) + " classes",
           std::to_string(rows) + " intensities and " + std::to_string(probability.size()) + " probabilities take " +
               std::to_string(rows * probability.size()),
           "Give a class for each pair"});
}

bool Options::writes(std::string_view word) const { return std::ranges::find(outputs, word) != outputs.end(); }

void Options::describe(recipe::Visitor& v) {
  v.path("run", run, "run.h5 of talus-solve; empty: the one in the output folder");
  v.number("footprint_threshold_m", footprint_threshold, recipe::positive, "footprint: peak thickness above this");
  v.number("deposit_threshold_m", deposit_threshold, recipe::positive, "deposit: final thickness above this");
  v.numbers("classes_m", classes, recipe::positive,
            "lower limits of the map's thickness classes, rising; empty: four to six of 0.1 0.5 1 2 5 10 25 50 100 200 "
            "500 that "
            "fit the thickest, and finer ones below them where it is thin");
  need_classes(v, classes);
  v.names("accept", accept, {"change-outside-slide", "swapped-surveys"},
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
      "outputs", outputs, writers.words(),
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
