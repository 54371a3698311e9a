// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "common/ensemble/fit_options.hpp"
#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "common/recipe/used.hpp"
#include "common/stage/files.hpp"
#include "common/stage/identity.hpp"
#include "talus/commands.hpp"
#include "talus/fitted_recipe.hpp"
#include "talus/search.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// The number that decides how far a slide goes on the bed of a law, in the form that the recipe gives.
struct LawFriction {
  std::string_view law, coefficient, angle;
};
constexpr LawFriction frictions[] = {{"velocity-weakening", "steady_coefficient", ""},
                                     {"pouliquen", "stop_coefficient", "stop_angle_deg"},
                                     {"samosat", "friction_coefficient", ""},
                                     {"", "friction_coefficient", "friction_angle_deg"}};  // of all others
constexpr double widest = 4;  // bounds over the recipe's value
constexpr double most_degrees = 60;
constexpr double steep = 3;  // per cent of run-out for one of the key, from which it is called a cliff

/// "solve.part 1" and "release", as in a used recipe, for "solve.part[0].release".
std::pair<std::string, std::string> place_in_used(const std::string& key) {
  std::string table = key.substr(0, key.rfind('.'));
  for (auto open = table.find('['); open != std::string::npos; open = table.find('[')) {
    const auto close = table.find(']', open);
    table.replace(open, close - open + 1, fmt::format(" {}", std::stoi(table.substr(open + 1)) + 1));
  }
  return {table, key.substr(key.rfind('.') + 1)};
}

/// All keys of the stages with their values, defaults filled in.
std::vector<recipe::UsedKey> keys_of(const Request& request) {
  std::vector<recipe::UsedKey> keys;
  for (const char* name : stage_names) {
    const Stage stage = stage_called(name);
    const std::string text = stage.used_toml(open_call(stage, call_of(request, name)).recipe);
    const auto used = recipe::read_used_recipe(text, stage.name);
    keys.insert(keys.end(), used.keys.begin(), used.keys.end());
  }
  return keys;
}

std::string friction_key(const std::vector<recipe::UsedKey>& known) {
  const auto find = [&](std::string_view key) {
    return std::ranges::find_if(
        known, [&](const recipe::UsedKey& one) { return one.table == "solve.base" && one.key == key; });
  };
  const auto law = find("law");
  for (const LawFriction& friction : frictions) {
    if (!friction.law.empty() && (law == known.end() || law->value != recipe::toml_text(friction.law))) continue;
    for (const std::string_view key : {friction.coefficient, friction.angle})
      if (find(key) != known.end()) return fmt::format("solve.base.{}", key);
    break;
  }
  throw RecipeError({"[fit] keys is empty", "the recipe gives the law of [solve.base] no friction",
                     "Name a key: keys = [\"solve.base. ...\"]"});
}

/// The keys that are fitted, each with the recipe's value and its bounds.
std::vector<FitKey> keys_to_fit(const FitOptions& options, const std::vector<recipe::UsedKey>& known) {
  std::vector<std::string> names = options.keys;
  if (names.empty()) names.push_back(friction_key(known));
  std::vector<FitKey> keys;
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto place = place_in_used(names[n]);
    const auto used = std::ranges::find_if(
        known, [&](const recipe::UsedKey& one) { return one.table == place.first && one.key == place.second; });
    const char* behind = used == known.end() ? nullptr : used->value.c_str();
    char* end = nullptr;
    const double start = behind == nullptr ? 0 : std::strtod(behind, &end);
    const bool bounded = n < options.low.size() && n < options.high.size();
    if (behind == nullptr || end == behind || (!(start > 0) && !bounded))
      throw RecipeError({fmt::format("[fit] keys: {}", names[n]),
                         behind == nullptr ? "the recipe uses no key of this name"
                         : end == behind   ? fmt::format("its value is {}, no number", used->value)
                                           : "its value is not above 0, so that no bounds follow from it",
                         behind == nullptr || end == behind ? "Name a number that the recipe uses, with its tables"
                                                            : "Give low and high"});
    FitKey key{names[n], start, start / widest, start * widest};
    if (place.second.ends_with("_deg")) key.high = std::max(start, std::min(key.high, most_degrees));
    if (n < options.low.size()) key.low = options.low[n];
    if (n < options.high.size()) key.high = options.high[n];
    keys.push_back(key);
  }
  return keys;
}

/// A search whose runs are those of a scene, in its folder of results.
class Fit {
 public:
  Fit(const Request& request, FitProblem problem)
      : request_(request), problem_(std::move(problem)), inputs_(inputs_mark(request)) {
    const auto text = text_if_there(file());
    const auto json = nlohmann::json::parse(text.value_or(""), nullptr, false);
    for (const char* list : {"runs", "others"})
      if (json.is_object() && json.contains(list)) known_.insert(known_.end(), json[list].begin(), json[list].end());
  }

  std::vector<FitRun> run() {
    log_info(head());
    return search(problem_, [this](const std::vector<double>& values) { return scored(values); });
  }

  fs::path file() const { return request_.out / "fit.json"; }

  /// "key=value" of each key.
  std::vector<std::string> set(const std::vector<double>& values) const {
    std::vector<std::string> set;
    for (std::size_t n = 0; n < values.size(); ++n)
      set.push_back(fmt::format("{}={}", problem_.keys[n].name, recipe::toml_number(values[n])));
    return set;
  }

  std::string line(const std::vector<double>& values, const FitScore& score) const {
    std::string text;
    for (std::size_t n = 0; n < values.size(); ++n) text += fmt::format("{:>{}.4g}  ", values[n], short_name(n).size());
    const auto number = [](double value, int width, int decimals) {
      const double half = 0.5 * std::pow(10.0, -decimals);
      return std::isfinite(value) ? fmt::format("{:>{}.{}f}", std::abs(value) < half ? 0 : value, width, decimals)
                                  : fmt::format("{:>{}}", "-", width);
    };
    return text + number(score.runout, 11, 0) + "  " + number(score.runout_difference, 12, 0) + "  " +
           number(score.overlap, 7, 3) + "  " + number(score.thickness_error, 18, 2);
  }

  std::string head() const {
    std::string text;
    for (std::size_t n = 0; n < problem_.keys.size(); ++n) text += short_name(n) + "  ";
    return text + "run-out [m]  - survey [m]  overlap  thickness RMSE [m]";
  }

  std::string short_name(std::size_t key) const {
    const std::string& name = problem_.keys[key].name;
    return name.substr(name.rfind('.') + 1);
  }

  void write(std::optional<std::size_t> best) const {
    nlohmann::ordered_json json;
    for (const FitKey& key : problem_.keys) json["keys"].push_back(key.name);
    json["runs"] = made_;
    json["others"] = nlohmann::json::array();
    for (const auto& run : known_)
      if (std::ranges::none_of(made_, [&](const auto& own) { return own["mark"] == run.value("mark", ""); }))
        json["others"].emplace_back(run);
    if (best) json["best"] = *best;
    write_text(file(), json.dump(2) + "\n");
  }

 private:
  FitScore scored(const std::vector<double>& values) {
    Request one = request_;
    for (const std::string& value : set(values)) one.set.push_back(value);
    one.set.emplace_back("postprocess.outputs=[]");
    const std::string mark = run_mark(one, inputs_);
    const auto known = std::ranges::find_if(known_, [&](const auto& run) { return run.value("mark", "") == mark; });
    FitScore score;
    if (known != known_.end()) {
      made_.emplace_back(*known);
      score = score_in(*known);
    } else {
      score = computed(one);
      made_.push_back({{"values", values},
                       {"runout_m", score.runout},
                       {"runout_difference_m", score.runout_difference},
                       {"overlap", score.overlap},
                       {"thickness_rmse_m", score.thickness_error},
                       {"mark", mark}});
      write(std::nullopt);
    }
    log_info(line(values, score));
    refuse_idle(score);
    return score;
  }

  static FitScore computed(const Request& request) {
    Said said = run_quietly(request);
    if (said.outcome.code != ExitCode::success) throw StageFailed{std::move(said.outcome)};
    const std::string text = text_if_there(request.out / "score.json").value_or("");
    const auto json = nlohmann::json::parse(text, nullptr, false);
    FitScore score = score_in(json);
    for (const char* overlap : {"footprint_csi", "deposit_csi"})
      if (json.is_object() && json.contains(overlap)) score.overlap = json[overlap].get<double>();
    if (!std::isfinite(score.overlap) && !std::isfinite(score.runout_difference))
      throw DataError({request.recipe.string() + ": its run is scored against nothing",
                       "a fit compares runs with a survey",
                       "Give [postprocess.survey] a thickness, a change of surface or a polygon"});
    return score;
  }

  static FitScore score_in(const nlohmann::json& json) {
    const auto number = [&](const char* key) {
      return json.is_object() && json.contains(key) && json[key].is_number() ? json[key].get<double>() : std::nan("");
    };
    return {number("runout_m"), number("runout_difference_m"), number("overlap"), number("thickness_rmse_m")};
  }

  /// Refuses a search whose first runs all score the same.
  void refuse_idle(const FitScore& score) {
    constexpr int enough = 4;
    const auto is_first = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    if (!first_) first_ = score;
    alike_ = alike_ >= 0 && is_first(first_->runout, score.runout) && is_first(first_->overlap, score.overlap) &&
                     is_first(first_->thickness_error, score.thickness_error)
                 ? alike_ + 1
                 : -1;
    if (alike_ < enough) return;
    throw RecipeError(
        {fmt::format("[fit]: {} has no effect", problem_.keys.front().name),
         fmt::format(
             "{} runs with different values score the same: either the mass moves with none of them, or the key "
             "does not act (rasters and polygons of [preprocess.bed] take the place of [solve.base])",
             enough),
         "Begin with a value at which the mass moves, or name a key that acts"});
  }

  const Request& request_;
  FitProblem problem_;
  std::string inputs_;
  std::vector<nlohmann::json> known_;                              ///< runs of earlier calls
  nlohmann::ordered_json made_ = nlohmann::ordered_json::array();  ///< of this one
  std::optional<FitScore> first_;
  int alike_ = 0;  ///< runs so far that scored as the first one; -1: one did not
};

/// Where the curve of one key is steep, in words.
std::string steep_words(const Fit& fit, const std::vector<FitRun>& runs) {
  const Steepest s = steepest_of(runs);
  if (s.elasticity == 0) return "";
  return fmt::format(
      "Steepest: from {} = {:.4g} to {:.4g} the run-out goes from {:.0f} to {:.0f} m, {:.1f} % for 1 %{}",
      fit.short_name(0), s.low, s.high, s.runout_low, s.runout_high, s.elasticity,
      std::abs(s.elasticity) > steep ? ". Near such a cliff a small error of the value decides: give ranges" : "");
}

/// Says where the overlap asks for another value than the run-out.
void warn_of_two_minds(const Fit& fit, const std::vector<FitRun>& runs, std::size_t best) {
  constexpr double clearly = 0.05;
  const FitRun& other = *std::ranges::max_element(
      runs, {}, [](const FitRun& run) { return std::isfinite(run.score.overlap) ? run.score.overlap : -1; });
  if (!(other.score.overlap > runs[best].score.overlap + clearly)) return;
  log_warning(fmt::format(
      "run-out and overlap ask for different values: with {} the overlap is {:.3f} instead of {:.3f}, and the run ends "
      "{:.0f} m from the survey's end. The shape of the deposit does not follow from this key alone: look at both maps",
      fmt::join(fit.set(other.values), ", "), other.score.overlap, runs[best].score.overlap,
      std::abs(other.score.runout_difference)));
}

/// Where the values come from.
std::vector<std::string> fitted_lines(const Fit& fit, const FitProblem& problem, const std::vector<FitRun>& runs,
                                      std::size_t best) {
  std::vector<std::string> lines;
  for (std::size_t n = 0; n < problem.keys.size(); ++n)
    lines.push_back(fmt::format("{} = {:.4g} is the best of {} runs between {:.4g} and {:.4g}; the recipe had {:.4g}.",
                                problem.keys[n].name, runs[best].values[n], runs.size(), problem.keys[n].low,
                                problem.keys[n].high, problem.keys[n].start));
  lines.push_back(fit.head());
  lines.push_back(fit.line(runs[best].values, runs[best].score));
  return lines;
}

std::vector<std::string> all_of(const std::vector<std::string>& some, const std::vector<std::string>& more) {
  std::vector<std::string> all = some;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// The values by which a recipe of many runs is one of its own. Throws RecipeError: many slides, changes of one run.
std::vector<std::string> one_run(const recipe::Recipe& recipe) {
  const EnsembleOptions ensemble = ensemble_of(recipe);
  if (!ensemble.on()) return {};
  if (ensemble.members > 0 && !ensemble.is_budget()) return {"ensemble.members=0"};
  throw RecipeError({fmt::format("talus fit of a recipe with design = \"{}\"", design_name(ensemble.design)),
                     "it changes a single run, and this recipe makes others", "Leave [slides] or the design out"});
}

}  // namespace

int fit_scene(const Request& request) {
  require_tables(request);
  const recipe::Recipe recipe(request.recipe, request.set);
  const auto options = recipe.read<FitOptions>("fit");
  const FitProblem problem{keys_to_fit(options, keys_of(request)), options.runs};
  const FittedRecipe fitted(request, "talus fit");
  make_folder(request.out);
  const std::vector<std::string> alone = one_run(recipe);
  Request single = request, best_run = request;
  single.set = all_of(request.set, alone);
  try {
    const OutputLock lock(request.out, "talus fit");
    Fit fit(single, problem);
    const std::vector<FitRun> runs = fit.run();
    const std::size_t best = best_of(runs);
    if (!std::isfinite(runs[best].score.runout_difference) && !(runs[best].score.overlap > 0))
      throw DataError({request.recipe.string() + ": no run meets the survey anywhere",
                       "it holds no deposit, or lies elsewhere", "Look at both in a GIS"});
    fit.write(best);
    if (problem.keys.size() == 1)
      if (const std::string words = steep_words(fit, runs); !words.empty()) log_info(words);
    warn_of_two_minds(fit, runs, best);
    log_info(fmt::format("Best: {}", fmt::join(fit.set(runs[best].values), ", ")));
    fitted.write(all_of(request.set, fit.set(runs[best].values)), fitted_lines(fit, problem, runs, best));
    print_results({fitted.file(), fit.file()});
  } catch (const StageFailed& failed) {
    return report_faults("talus fit", failed.outcome);
  }
  best_run.recipe = fitted.file();
  best_run.set = alone;
  return run_scene(best_run);
}

}  // namespace talus::command
