// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/options.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "common/ensemble/slide_options.hpp"

namespace talus {
namespace {

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
    case Distribution::table: return {.bounds_taken = false};
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

/// What the rules of one [[ensemble.vary]] are written with.
class VaryRules {
 public:
  VaryRules(recipe::Visitor& v, const VaryOptions& options)
      : v_(v), shown_(options.key.empty() ? "[[ensemble.vary]]" : "[[ensemble.vary]] of " + options.key) {}
  void need(bool met, const std::string& what, const std::string& why, const std::string& mend) const {
    v_.needs(met, {shown_ + ": " + what, why, mend});
  }

 private:
  recipe::Visitor& v_;
  std::string shown_;
};

/// This function declares what a distribution needs of its bounds and moments, and what has no effect.
void need_moments(const VaryRules& rules, const VaryOptions& o) {
  const Parameters takes = parameters_of(o.distribution);
  rules.need(!takes.bounds_needed || (o.low && o.high), "low or high is missing", "the distribution lies between them",
             "Give both");
  rules.need(takes.bounds_taken || (!o.low && !o.high), "low and high have no effect", "its values are listed",
             "Leave them out");
  rules.need(!o.low || !o.high || *o.low < *o.high, "low is not below high", "no value lies between them",
             "Mend one of them");
  rules.need(!takes.moments || (o.mean && o.deviation), "mean or deviation is missing",
             "the distribution is given by them", "Give both");
  rules.need(takes.moments || (!o.mean && !o.deviation), "mean and deviation have no effect",
             "this distribution is not given by them", "Leave them out, or take distribution = \"normal\"");
  rules.need(o.distribution != Distribution::lognormal || !o.mean || *o.mean > 0, "mean is not above 0",
             "lognormal values are positive", "Give a positive mean, or take distribution = \"normal\"");
  rules.need(takes.mode || !o.mode, "mode has no effect", "only a triangular distribution has one", "Leave it out");
  rules.need(!takes.mode || (o.mode && o.low && o.high && *o.mode >= *o.low && *o.mode <= *o.high),
             "mode is not between low and high", "a triangle's top lies over its base", "Give one that is");
}

/// This function declares what a distribution needs of its values, and what has no effect.
void need_values(const VaryRules& rules, const VaryOptions& o) {
  const bool discrete = o.distribution == Distribution::discrete;
  const std::size_t choices = o.values.size() + o.words.size();
  rules.need(!discrete || choices > 0, "values are missing", "there is nothing to choose from", "Add values = [...]");
  rules.need(discrete || choices == 0, "values have no effect", "the distribution is not discrete",
             "Leave them out, or take distribution = \"discrete\"");
  rules.need(o.weights.empty() || o.weights.size() == choices, "weights do not match the values",
             fmt::format("there are {} of {}", o.weights.size(), choices), "Give one for each, or none");
  rules.need(o.weights.empty() || *std::max_element(o.weights.begin(), o.weights.end()) > 0, "all weights are 0",
             "nothing could be chosen", "Give a positive one");
  rules.need((o.distribution == Distribution::table) == !o.table.empty(), "table and distribution do not go together",
             "distribution = \"table\" is given by its file, and by nothing else", "Give both or neither");
}

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
  const VaryRules rules(v, *this);
  v.needs(!key.empty(), {"[[ensemble.vary]] without a key", "nothing would vary", "Add key = \"solve. ...\""});
  need_moments(rules, *this);
  need_values(rules, *this);
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
  recipe::choice(
      v, "design", design,
      {{design_name(Design::sobol), Design::sobol},
       {design_name(Design::latin_hypercube), Design::latin_hypercube},
       {design_name(Design::optimal_hypercube), Design::optimal_hypercube},
       {design_name(Design::monte_carlo), Design::monte_carlo},
       {design_name(Design::full_grid), Design::full_grid},
       {design_name(Design::one_at_a_time), Design::one_at_a_time},
       {design_name(Design::sensitivity), Design::sensitivity},
       {design_name(Design::table), Design::table},
       {design_name(Design::budget), Design::budget},
       {design_name(Design::slides), Design::slides}},
      "how the members are drawn; full-grid, one-at-a-time, table and budget give their number themselves, and "
      "sensitivity takes the largest number up to members that it can; budget: the recipe and single changes of it, "
      "members and [[ensemble.vary]] being left aside; slides: those of [slides], the default beside that table");
  v.integer("levels", levels, {2, 1000}, "full-grid, one-at-a-time: quantiles of each key");
  v.integer("seed", seed, {0, 2147483647}, "another seed draws other members");
  v.path("table", table, "design = \"table\": a CSV file, a column for each key that varies, a row for each member");
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
  if (vary.empty() && !elevation_error.acts() && design != Design::table)
    faults.push_back({"[ensemble] with nothing that varies", "all members would be the same run",
                      "Add [[ensemble.vary]], or [ensemble.elevation_error]"});
  if ((design == Design::table) == table.empty())
    faults.push_back({"[ensemble] table and design do not go together",
                      "design = \"table\" is given by its file, and by nothing else", "Give both or neither"});
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

const char* design_name(Design design) {
  switch (design) {
    case Design::sobol: return "sobol";
    case Design::latin_hypercube: return "latin-hypercube";
    case Design::optimal_hypercube: return "optimal-latin-hypercube";
    case Design::monte_carlo: return "monte-carlo";
    case Design::full_grid: return "full-grid";
    case Design::one_at_a_time: return "one-at-a-time";
    case Design::sensitivity: return "sensitivity";
    case Design::budget: return "budget";
    case Design::slides: return "slides";
    case Design::table: break;
  }
  return "table";
}

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

namespace {

/// [ensemble] beside [slides]: each threshold takes two maps of the whole model.
struct EnsembleOfSlides : EnsembleOptions {
  EnsembleOfSlides() {
    design = Design::slides;
    thresholds = {.thickness = {0.1, 0.5, 1}, .deposit = {}, .speed = {}, .pressure = {3, 30}, .arrival = {}};
  }
};

}  // namespace

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
      !ensemble.correlation.empty() || ensemble.elevation_error.acts())
    throw RecipeError({"[slides] beside [ensemble] with members of its own",
                       "either each slide is a member, or each draw of one slide",
                       "Leave [slides] out, or give failed_share, keep and thresholds alone in [ensemble]"});
  return ensemble;
}

}  // namespace talus
