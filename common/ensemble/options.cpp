// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/options.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

namespace talus {
namespace {

/// The words of a recipe, in the order of Design.
constexpr std::array<std::string_view, 11> designs{"sobol",       "latin-hypercube", "optimal-latin-hypercube",
                                                   "monte-carlo", "full-grid",       "one-at-a-time",
                                                   "sensitivity", "table",           "posterior",
                                                   "budget",      "slides"};

/// The keys that a distribution takes, and whether it needs them.
struct Parameters {
  bool bounds_needed = false, bounds_taken = true, moments = false, mode = false;
};

Parameters parameters_of(Distribution distribution) {
  switch (distribution) {
    case Distribution::uniform: return {.bounds_needed = true};
    case Distribution::normal:
    case Distribution::lognormal: return {.moments = true};
    case Distribution::triangular: return {.bounds_needed = true, .mode = true};
    case Distribution::beta: return {.bounds_needed = true, .moments = true};
    case Distribution::discrete:
    case Distribution::table:
    case Distribution::draws: return {.bounds_taken = false};
  }
  return {};
}

bool grows(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) == values.end();
}

void thresholds(recipe::Visitor& v, std::string_view key, std::vector<double>& values, std::string_view help) {
  v.numbers(key, values, recipe::positive, help);
  v.needs(grows(values), {fmt::format("[ensemble.thresholds] {} does not grow", key),
                          "each threshold is counted once, from the smallest", "Write them in order"});
}

/// Whether `keep` takes a word: a number as members are counted, or what is kept of all of them.
bool is_kept_word(const std::string& word) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool is_number = std::ranges::all_of(word, is_digit) && (word == "0" || !word.starts_with('0'));
  return (is_number && !word.empty() && word.size() < 10) || word == "all" || word == "deposits";
}

/// This function declares what a distribution needs of its bounds and moments, and what has no effect.
void need_moments(const auto& need, const VaryOptions& o) {
  const Parameters takes = parameters_of(o.distribution);
  need(!takes.bounds_needed || (o.low && o.high), "low or high is missing", "the distribution lies between them",
       "Give both");
  need(takes.bounds_taken || (!o.low && !o.high), "low and high have no effect", "its values are listed",
       "Leave them out");
  need(!o.low || !o.high || *o.low < *o.high, "low is not below high", "no value lies between them",
       "Mend one of them");
  need(!takes.moments || (o.mean && o.deviation), "mean or deviation is missing", "the distribution is given by them",
       "Give both");
  need(takes.moments || (!o.mean && !o.deviation), "mean and deviation have no effect",
       "this distribution is not given by them", "Leave them out, or take distribution = \"normal\"");
  need(o.distribution != Distribution::lognormal || !o.mean || *o.mean > 0, "mean is not above 0",
       "lognormal values are positive", "Give a positive mean, or take distribution = \"normal\"");
  need(takes.mode || !o.mode, "mode has no effect", "only a triangular distribution has one", "Leave it out");
  need(!takes.mode || (o.mode && o.low && o.high && *o.mode >= *o.low && *o.mode <= *o.high),
       "mode is not between low and high", "a triangle's top lies over its base", "Give one that is");
}

/// This function declares what a distribution needs of its values, and what has no effect.
void need_values(const auto& need, const VaryOptions& o) {
  const bool discrete = o.distribution == Distribution::discrete;
  const std::size_t choices = o.values.size() + o.words.size();
  need(!discrete || choices > 0, "values are missing", "there is nothing to choose from", "Add values = [...]");
  need(discrete || choices == 0, "values have no effect", "the distribution is not discrete",
       "Leave them out, or take distribution = \"discrete\"");
  need(o.weights.empty() || o.weights.size() == choices, "weights do not match the values",
       fmt::format("there are {} of {}", o.weights.size(), choices), "Give one for each, or none");
  need(o.weights.empty() || *std::max_element(o.weights.begin(), o.weights.end()) > 0, "all weights are 0",
       "nothing could be chosen", "Give a positive one");
  need((o.distribution == Distribution::table) == !o.table.empty(), "table and distribution do not go together",
       "distribution = \"table\" is given by its file, and by nothing else", "Give both or neither");
}

/// [ensemble] beside [slides]: each threshold takes two maps of the whole model.
struct EnsembleOfSlides : EnsembleOptions {
  EnsembleOfSlides() {
    design = Design::slides;
    thresholds = {.thickness = {0.1, 0.5, 1}, .deposit = {}, .speed = {}, .pressure = {3, 30}, .arrival = {}};
  }
};

constexpr recipe::Range steep{0, 90, true, true};

}  // namespace

void VaryOptions::describe(recipe::Visitor& v) {
  v.text("key", key, "the key that varies, with its tables: \"solve.base.friction_angle_deg\"");
  recipe::choice(v, "distribution", distribution,
                 {{"uniform", Distribution::uniform},
                  {"normal", Distribution::normal},
                  {"lognormal", Distribution::lognormal},
                  {"triangular", Distribution::triangular},
                  {"beta", Distribution::beta},
                  {"discrete", Distribution::discrete},
                  {"table", Distribution::table}},
                 "how its values are distributed");
  v.optional_number("low", low, recipe::any, "smallest value; of normal and lognormal: where it is cut off");
  v.optional_number("high", high, recipe::any, "largest value; of normal and lognormal: where it is cut off");
  v.optional_number("mean", mean, recipe::any, "normal, lognormal, beta: mean of the value itself");
  v.optional_number("deviation", deviation, recipe::positive, "normal, lognormal, beta: standard deviation");
  v.optional_number("mode", mode, recipe::any, "triangular: the most probable value");
  v.numbers("values", values, recipe::any, "discrete: the numbers that it takes");
  v.names("words", words, {}, "discrete: the words that it takes, such as the names of laws");
  v.numbers("weights", weights, recipe::not_negative, "discrete: their probabilities, up to a factor; none: alike");
  v.path("table", table, "table: a CSV file of values and their probability densities, which are joined by lines");
  const auto need = [&](bool met, const std::string& what, const std::string& why, const std::string& mend) {
    v.needs(met, {(key.empty() ? "[[ensemble.vary]]: " : "[[ensemble.vary]] of " + key + ": ") + what, why, mend});
  };
  v.needs(!key.empty(), {"[[ensemble.vary]] without a key", "nothing would vary", "Add key = \"solve. ...\""});
  need_moments(need, *this);
  need_values(need, *this);
}

void CorrelationOptions::describe(recipe::Visitor& v) {
  v.names("keys", keys, {}, "the two keys, as [[ensemble.vary]] names them");
  v.number("rank_correlation", rank_correlation, {-1, 1, true, true}, "Spearman's, of a normal copula [-]");
}

void ElevationErrorOptions::describe(recipe::Visitor& v) {
  v.optional_number("terrain_deviation_m", terrain_deviation, recipe::positive,
                    "standard deviation of the ground's error, under and around the slide");
  v.optional_number("thickness_deviation_m", thickness_deviation, recipe::positive,
                    "standard deviation of the released thickness");
  v.optional_number("range_m", range, recipe::positive, "distance from which errors are independent (spherical)");
  v.flag("from_survey", from_survey, "deviation and range as they are found on stable ground between the surveys");
  const bool given = terrain_deviation || thickness_deviation;
  const std::string name = "[ensemble.elevation_error] ";
  v.needs(!given || range.has_value(), {name + "range_m is missing", "errors of neighbouring cells are alike",
                                        "Give the distance from which they are independent, or from_survey = true"});
  v.needs(!from_survey || (!given && !range),
          {name + "numbers beside from_survey", "the survey gives them", "Leave one of them out"});
  v.needs(given || !range, {name + "range_m has no effect", "no deviation is given", "Add one, or leave it out"});
}

void ThresholdOptions::describe(recipe::Visitor& v) {
  thresholds(v, "thickness_m", thickness, "of the largest thickness: how many members exceed each is counted");
  thresholds(v, "deposit_m", deposit, "of the deposit's thickness at the end");
  thresholds(v, "speed_m_s", speed, "of the largest speed");
  thresholds(v, "pressure_kPa", pressure, "of the largest pressure");
  thresholds(v, "arrival_s", arrival, "times: how many members arrive before each is counted");
}

void EnsembleOptions::describe(recipe::Visitor& v) {
  v.integer("members", members, {0, most_members}, "number of runs; 0: one run, no ensemble");
  int place = static_cast<int>(design);
  v.one_of(
      "design", place, {designs.begin(), designs.end()},
      "how the members are drawn; full-grid, one-at-a-time, table, posterior and budget give their number themselves, "
      "and "
      "sensitivity takes the largest number up to members that it can; budget: the recipe and single changes of it, "
      "members and [[ensemble.vary]] being left aside; slides: those of [slides], the default beside that table");
  design = static_cast<Design>(place);
  v.integer("levels", levels, {2, 1000}, "full-grid, one-at-a-time: quantiles of each key");
  v.integer("seed", seed, {0, 2147483647}, "another seed draws other members");
  v.path("table", table,
         "design = \"table\": a CSV file, a column for each key that varies, a row for each member; \"posterior\": the "
         "draws.csv of talus calibrate");
  v.path(
      "prior", prior,
      "the posterior.csv of talus calibrate for another event, whose keys of [solve] vary here; or \"rock-avalanche\", "
      "\"debris-flow\", \"snow-avalanche\": friction that is usual for them. [[ensemble.vary]] of the same key "
      "goes before");
  v.number("failed_share", failed_share, recipe::fraction, "share of the members that may fail");
  v.names("keep", keep, {},
          "members whose whole run is kept, counted from 0: \"17\"; \"all\"; \"deposits\": of each the deposit's "
          "thickness, for its RMSE in members.csv");
  for (const std::string& word : keep)
    v.needs(is_kept_word(word), {fmt::format("[ensemble] keep holds \"{}\"", word), "nothing of that name is kept",
                                 "Give numbers of members, counted from 0 (\"17\"), \"all\" or \"deposits\""});
  recipe::table(v, "thresholds", thresholds, "what the probability maps count");
  recipe::table(v, "elevation_error", elevation_error, "the error of the elevation models, another field each member");
  recipe::table(v, "budget", budget, "design = \"budget\": which changes are made, and how large they are");
  recipe::list(v, "vary", vary, "a key that varies from member to member");
  recipe::list(v, "correlation", correlation, "two keys that vary together");
}

void EnsembleOptions::check(std::vector<Fault>& faults) const {
  if (is_budget()) return budget.check(faults);
  if (!on() || design == Design::slides) return;
  if (vary.empty() && prior.empty() && !elevation_error.acts() && design != Design::table)
    faults.push_back({"[ensemble] with nothing that varies", "all members would be the same run",
                      "Add [[ensemble.vary]], prior, or [ensemble.elevation_error]"});
  if ((design == Design::table || design == Design::posterior) == table.empty())
    faults.push_back({"[ensemble] table and design do not go together",
                      "design = \"table\" and \"posterior\" are given by a file, and no other is",
                      "Give both or neither"});
  std::set<std::string> keys;
  for (const VaryOptions& one : vary)
    if (!keys.insert(one.key).second)
      faults.push_back({"[[ensemble.vary]] of " + one.key + " is there twice", "one value would hide the other",
                        "Leave one of them out"});
  for (const CorrelationOptions& pair : correlation) {
    if (pair.keys.size() != 2 || pair.keys[0] == pair.keys[1])
      faults.push_back({"[[ensemble.correlation]] does not name two keys", "a correlation is between two",
                        "Write keys = [\"...\", \"...\"]"});
    for (const std::string& key : pair.keys)
      if (!keys.contains(key))
        faults.push_back({"[[ensemble.correlation]] of " + key, "it does not vary", "Add it to [[ensemble.vary]]"});
  }
}

std::string design_name(Design design) { return std::string(designs.at(static_cast<std::size_t>(design))); }

Fault EnsembleOptions::too_many_failed(const std::string& what, const std::string& first) const {
  if (is_budget())
    return {what, "none is left to compare: " + first,
            "Mend what makes them fail, or leave their rows out (leave_out)"};
  return {what, fmt::format("[ensemble] failed_share allows {:g} %: {}", 100 * failed_share, first),
          "Mend what makes them fail, narrow the distributions, or raise failed_share"};
}

bool EnsembleOptions::keeps(const std::string& word) const { return std::ranges::find(keep, word) != keep.end(); }

void EnsembleOptions::check_kept(std::int64_t count) const {
  for (const std::string& word : keep)
    if (word != "all" && word != "deposits" && std::stoll(word) >= count)
      throw RecipeError({"[ensemble] keep names member " + word, fmt::format("there are {}, counted from 0", count),
                         "Name one that is there"});
}

EnsembleOptions ensemble_of(const recipe::Recipe& recipe) {
  if (!slides_of(recipe).on()) {
    auto ensemble = recipe.read<EnsembleOptions>("ensemble");
    if (ensemble.design == Design::slides)
      throw RecipeError({"[ensemble] design = \"slides\" without [slides]", "nothing says where the slides are",
                         "Add [slides] with outlines, or take another design"});
    return ensemble;
  }
  EnsembleOptions ensemble = recipe.read<EnsembleOfSlides>("ensemble");
  if (ensemble.design != Design::slides || ensemble.members > 0 || !ensemble.table.empty() || !ensemble.vary.empty() ||
      !ensemble.prior.empty() || !ensemble.correlation.empty() || ensemble.elevation_error.acts())
    throw RecipeError({"[slides] beside [ensemble] with members of its own",
                       "either each slide is a member, or each draw of one slide",
                       "Leave [slides] out, or give failed_share, keep and thresholds alone in [ensemble]"});
  return ensemble;
}

void SlideKeyOptions::describe(recipe::Visitor& v) {
  v.text("key", key,
         "a key of [preprocess] or [solve] with its tables: solve.base.friction_angle_deg; what is released: "
         "preprocess.release[0].thickness_m (base_dem), preprocess.source.sliding_surface.depth_m or volume_m3 "
         "(before_dem)");
  v.text("attribute", attribute, "the attribute of the polygons that holds its value");
  v.needs(!key.empty() && !attribute.empty(), {"[[slides.set]] without key or attribute", "nothing would be set",
                                               "Write key = \"solve. ...\" and attribute = \"...\""});
}

void ScenarioOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of the slide");
  v.path("outline", outline, "vector file of its polygons: FILE|layername=LAYER|subset=CONDITION");
  v.names("set", set, {}, "values of keys, \"key=value\" each: \"preprocess.release[0].thickness_m=3\"");
  const std::string shown = name.empty() ? "[[slides.scenario]]" : "[[slides.scenario]] " + name;
  v.needs(!outline.empty(), {shown + " has no outline", "its polygons are not known",
                             "Give outline = \"FILE|layername=LAYER|subset=CONDITION\""});
  v.needs(!name.empty(), {"[[slides.scenario]] without a name", "results are told apart by name", "Name it"});
}

void SlideOptions::describe(recipe::Visitor& v) {
  v.path("outlines", outlines,
         "vector file of polygons over the model of [preprocess], each a slide: FILE|layername=LAYER|subset=CONDITION");
  v.text("name_from", name_from, "attribute that holds their names; empty = slide-1, slide-2 and so on by feature id");
  v.optional_number("margin_m", margin, recipe::not_negative,
                    "the domain of a slide is the rectangle around its outline, and this on all sides");
  v.number(
      "reach_angle_deg", reach_angle, steep,
      "without margin_m: the domain holds all ground that lies below a line from the slide's highest point at this "
      "angle");
  recipe::choice(v, "at_edge", at_edge, {{"flag", SlideAtEdge::flag}, {"fail", SlideAtEdge::fail}},
                 "a slide that comes to the edge of its domain is counted and named, or counts as failed");
  recipe::list(v, "set", vary, "a key of the recipe that takes the value of an attribute");
  recipe::list(v, "scenario", scenario, "a slide that is listed here");
}

void SlideOptions::check(std::vector<Fault>& faults) const {
  if (!on()) return;
  const bool by_layer = !outlines.empty() || !name_from.empty() || !vary.empty();
  if (!scenario.empty() && by_layer)
    faults.push_back({"[slides]: outlines or attributes beside [[slides.scenario]]",
                      "a recipe that lists slides gives their outlines, names and values itself",
                      "Give these in [[slides.scenario]], or leave that out and have every polygon a slide"});
  std::set<std::string> keys, names;
  for (const SlideKeyOptions& one : vary)
    if (!keys.insert(one.key).second)
      faults.push_back(
          {"[[slides.set]] of " + one.key + " is there twice", "one value would hide the other", "Leave one out"});
  for (const ScenarioOptions& one : scenario)
    if (!names.insert(one.name).second)
      faults.push_back({fmt::format("[[slides.scenario]]: name \"{}\" is taken", one.name),
                        "results are told apart by name", "Name it otherwise"});
}

SlideOptions slides_of(const recipe::Recipe& recipe) { return recipe.read<SlideOptions>("slides"); }

}  // namespace talus
