// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "common/domain/domain.hpp"
#include "common/ensemble/fit_options.hpp"
#include "common/ensemble/openturns.hpp"
#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "common/stage/files.hpp"
#include "preprocess/stage.hpp"
#include "talus/commands.hpp"
#include "talus/fitted_recipe.hpp"
#include "talus/posterior.hpp"
#include "talus/tempering.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int draws_of_a_key = 10;  // at least

Json json_of(const PosteriorSummary& summary) {
  const auto three = [](const Quantiles& of) { return Json{of.low, of.median, of.high}; };
  Json json{{"log_evidence", summary.log_evidence}, {"log_evidence_error", summary.log_evidence_error}};
  for (const KeySummary& key : summary.keys)
    json["keys"].push_back({{"key", key.key},
                            {"before", three(key.prior)},
                            {"after", three(key.posterior)},
                            {"left", key.left},
                            {"shift", key.shift}});
  for (const Direction& one : summary.directions)
    json["directions"].push_back({{"of_keys", one.of_keys}, {"left", one.left}});
  json["conclusions"] = conclusions(summary);
  return json;
}

/// Whether the draws of two batches are the same.
bool same_draws(const Json& batch, const Places& places) {
  return batch.is_object() && batch.contains("draws") && batch["draws"].get<Places>() == places;
}

/// Calls a stage, and throws where it fails.
void call_or_throw(const char* stage, const StageCall& call) {
  Said said = call_quietly(stage, call);
  if (said.outcome.code != ExitCode::success) throw StageFailed{std::move(said.outcome)};
}

/// Runs of a recipe at places in the space of its keys, on its own cells or on larger ones.
class Model {
 public:
  /// `keys`: of [[ensemble.vary]], in their order.
  Model(Request request, std::vector<std::string> keys, Json& journal, fs::path file)
      : request_(std::move(request)), keys_(std::move(keys)), journal_(journal), file_(std::move(file)) {
    mark_ = run_mark(request_, inputs_mark(request_));
    for (const Json& batch : journal["batches"])
      if (batch.value("mark", "") == mark_) known_.push_back(batch);
  }

  std::vector<double> operator()(const Places& places) {
    Json batch{{"mark", mark_}, {"cells", request_.out.filename().string()}, {"draws", places}};
    const auto known = std::ranges::find_if(known_, [&](const Json& one) { return same_draws(one, places); });
    std::vector<double> found = known != known_.end() ? numbers_in((*known)["log_likelihood"]) : computed(places);
    batch["log_likelihood"] = found;  // what failed becomes null
    journal_["made"].push_back(std::move(batch));
    if (known == known_.end()) write_text(file_, journal_.dump() + "\n");
    runs_ += places.size();
    for (std::size_t k = 0; k < places.size(); ++k) keep_best(places[k], found[k]);
    const auto best = *std::ranges::max_element(found);
    const auto failed = std::ranges::count(found, impossible);
    log_info(fmt::format("{} runs{}: largest log-likelihood {:.2f}{}", runs_, known != known_.end() ? " (known)" : "",
                         best, failed > 0 ? fmt::format("; {} failed", failed) : ""));
    return found;
  }

  std::size_t runs() const { return runs_; }
  /// Of all runs the most probable one: where prior times likelihood is largest.
  const Places& best() const { return best_; }

  /// The request of the ensemble whose members are these places.
  Request members_at(const Places& places) const {
    const openturns::AnyLaw normal = openturns::library().normal(0, 1);
    std::string text = fmt::format("{}\n", fmt::join(keys_, ","));
    for (const auto& place : places) {
      std::vector<std::string> shares;
      for (const double one : place)
        shares.push_back(recipe::toml_number(std::clamp(normal->below(one), smallest, 1 - smallest)));
      text += fmt::format("{}\n", fmt::join(shares, ","));
    }
    const fs::path table = request_.out / "draws.csv";
    write_text(table, text);
    Request request = request_;
    for (const std::string& value :
         {std::string("ensemble.design=posterior"), "ensemble.table=" + recipe::toml_text(table.string()),
          std::string("ensemble.keep=[\"deposits\"]")})
      request.set.push_back(value);
    return request;
  }

  /// The values of members at these places, without their runs.
  MemberTable drawn(const Places& places) const {
    call_or_throw("preprocess", call_of(members_at(places), "preprocess"));
    return read_member_table(EnsemblePaths{request_.out}.members());
  }

  /// Runs them.
  std::vector<double> computed(const Places& places) const {
    make_folder(request_.out);
    const Request members = members_at(places);
    for (const char* stage : stage_names) {
      StageCall call = call_of(members, stage);
      if (std::string_view(stage) == "solve") call.flags.emplace_back("--resume", "");
      if (std::string_view(stage) == "postprocess") call.flags.emplace_back("--members-only", "");
      call_or_throw(stage, call);
    }
    const auto json = Json::parse(text_if_there(request_.out / "likelihood.json").value_or(""), nullptr, false);
    if (!json.is_object())
      throw DataError({request_.recipe.string() + ": its runs are compared with nothing",
                       "a calibration needs a survey",
                       "Give [postprocess.survey] a thickness, a change of surface or a polygon"});
    return numbers_in(json["log_likelihood"]);
  }

 private:
  static constexpr double smallest = 1e-12;  // of a share

  void keep_best(const Places::value_type& place, double log_likelihood) {
    double squares = 0;
    for (const double one : place) squares += one * one;
    const double density = log_likelihood - squares / 2;
    if (!best_.empty() && !(density > density_)) return;
    best_ = {place};
    density_ = density;
  }

  static std::vector<double> numbers_in(const Json& list) {
    std::vector<double> numbers;
    for (const Json& one : list) numbers.push_back(one.is_number() ? one.get<double>() : impossible);
    return numbers;
  }

  Request request_;
  std::vector<std::string> keys_;
  Json& journal_;
  fs::path file_;
  std::string mark_;
  std::vector<Json> known_;  ///< batches of earlier calls
  std::size_t runs_ = 0;
  Places best_;  ///< one
  double density_ = impossible;
};

/// Refuses a recipe that gives no distributions, or members of another kind.
EnsembleOptions priors_of(const recipe::Recipe& recipe) {
  EnsembleOptions options = preprocess::ensemble_with_prior(recipe);
  const auto refuse = [](const std::string& what, const std::string& why, const std::string& mend) {
    throw RecipeError({"talus calibrate: " + what, why, mend});
  };
  if (options.is_budget() || options.design == Design::slides || options.design == Design::table)
    refuse(fmt::format("design = \"{}\"", design_name(options.design)), "it draws nothing from distributions",
           "Leave [slides] or the design out");
  if (options.vary.empty())
    refuse("no [[ensemble.vary]]", "it gives what is known of a key before the survey", "Add one for each key");
  if (options.elevation_error.acts())
    refuse("[ensemble.elevation_error]", "members of the same values would differ, and so would their likelihoods",
           "Leave it out: the survey's error is in the likelihood");
  if (const auto least = draws_of_a_key * static_cast<int>(options.vary.size()); options.members < least)
    refuse(fmt::format("members = {}", options.members),
           fmt::format("{} keys need {} draws at least", options.vary.size(), least), "Give more, best 100 or more");
  return options;
}

/// The first draws, of the prior.
Places prior_places(const EnsembleOptions& options) {
  const openturns::AnyLaw normal = openturns::library().normal(0, 1);
  Places places = openturns::library().draw(Design::sobol, static_cast<std::size_t>(options.members),
                                            options.vary.size(), static_cast<unsigned long>(options.seed));
  for (auto& place : places)
    for (double& one : place) one = normal->quantile(std::clamp(one, 1e-12, 1 - 1e-12));
  return places;
}

/// The same recipe on cells so many times as large, beside its results.
Request on_larger_cells(const Request& request, double factor) {
  call_or_throw("preprocess", call_of(request, "preprocess"));
  const Domain domain = read_domain(request.out / "domain.vdb");
  Request larger = request;
  larger.out = request.out / "larger-cells";
  larger.shown = request.shown.empty() ? larger.out : request.shown / "larger-cells";
  larger.set.push_back(fmt::format("preprocess.grid.spacing_m={}", factor * domain.grid.cell));
  larger.set.push_back(fmt::format("preprocess.grid.layer_height_m={}", factor * domain.layer_height));
  return larger;
}

/// What likelihood.json says of the discrepancy after the survey.
std::vector<DiscrepancySummary> discrepancies_in(const fs::path& file) {
  const auto json = Json::parse(text_if_there(file).value_or(""), nullptr, false);
  std::vector<DiscrepancySummary> all;
  if (!json.is_object()) return all;
  for (const Json& kind : json["compared"]) {
    DiscrepancySummary one{kind["name"], kind["unit"], 0, 0, kind["survey_error"], 0, 0};
    double log_length = 0, least = 1e300, most = 0;
    for (const Json& entry : kind["discrepancy"]) {
      least = std::min(least, entry[0].get<double>());
      most = std::max(most, entry[0].get<double>());
    }
    for (const Json& entry : kind["discrepancy"]) {
      const double deviation = entry[0], length = entry[1], probability = entry[2];
      one.deviation += probability * deviation;
      if (length > 0) log_length += probability * std::log(length);
      if (deviation <= least) one.at_least += probability;
      if (deviation >= most) one.at_most += probability;
    }
    one.length = log_length > 0 ? std::exp(log_length) : 0;
    all.push_back(std::move(one));
  }
  return all;
}

std::string posterior_csv(const Posterior& draws, const MemberTable& table) {
  std::string text;
  for (const MemberColumn& column : table.columns) text += column.key + ",";
  text += "log_likelihood\n";
  for (std::size_t k = 0; k < draws.places.size(); ++k) {
    for (const MemberColumn& column : table.columns)
      text += (column.words.empty() ? recipe::toml_number(column.values[k])
                                    : column.words[static_cast<std::size_t>(column.values[k])]) +
              ",";
    text += fmt::format("{}\n", draws.log_likelihoods[k]);
  }
  return text;
}

/// The keys' values of the first batch, by key.
Json values_json(const MemberTable& table) {
  Json json;
  for (const MemberColumn& column : table.columns) json[column.key] = column.values;
  return json;
}

void log_steps(const Posterior& draws) {
  for (const TemperingStep& step : draws.steps)
    log_info(fmt::format("{}exponent {:.3g}: {:.0f} of {} draws effective, {} sweeps, {:.0f} % accepted",
                         step.model > 0 ? "own cells, " : "", step.exponent, step.effective, draws.places.size(),
                         step.sweeps, 100 * step.accepted));
}

/// Says, and warns where it matters, how far the draws' likelihoods differ when they are run again.
void say_noise(const Posterior& draws, const std::vector<double>& again) {
  constexpr double matters = 0.5;
  double most = 0;
  for (std::size_t k = 0; k < again.size(); ++k)
    if (const double apart = std::abs(again[k] - draws.log_likelihoods[k]); !(apart <= most)) most = apart;
  const std::string words = fmt::format("run again, the draws' log-likelihoods differ by {:.2g} at most", most);
  most <= matters ? log_info(words)
                  : log_warning(words +
                                ": thin flows on rough ground are chaotic (--on cpu and solve.deterministic "
                                "repeat every bit), so that the intervals are somewhat too narrow");
}

class Calibration {
 public:
  explicit Calibration(const Request& request)
      : request_(request), fitted_(request, "talus calibrate"), file_(request.out / "calibration.json") {
    const recipe::Recipe recipe(request.recipe, request.set);
    options_ = priors_of(recipe);
    factor_ = recipe.read<CalibrateOptions>("calibrate").cell_factor;
    for (const VaryOptions& one : options_.vary) keys_.push_back(one.key);
    const auto json = Json::parse(text_if_there(file_).value_or(""), nullptr, false);
    journal_ = {{"batches", Json::array()}, {"made", Json::array()}};
    for (const char* list : {"batches", "made"})
      if (json.is_object() && json.contains(list))
        for (const Json& batch : json[list]) journal_["batches"].push_back(batch);
  }

  /// The request of the ensemble of the draws, once they are made.
  Request run() {
    const Places first = prior_places(options_);
    std::optional<Model> larger;
    if (factor_ > 1) larger.emplace(on_larger_cells(request_, factor_), keys_, journal_, file_);
    Model own(request_, keys_, journal_, file_);
    std::vector<LogLikelihoods> models;
    if (larger) models.emplace_back(std::ref(*larger));
    models.emplace_back(std::ref(own));
    log_info(fmt::format("{} draws of {} keys{}", first.size(), keys_.size(),
                         larger ? fmt::format(", first on cells {:g} times as large", factor_) : ""));
    const Posterior draws = draw_posterior(first, static_cast<unsigned>(options_.seed), models);
    log_steps(draws);
    const MemberTable prior = own.drawn(first), most_probable = own.drawn(own.best());
    say_noise(draws, own.computed(draws.places));
    const MemberTable posterior = read_member_table(EnsemblePaths{request_.out}.members());
    PosteriorSummary summary = summary_of(draws, prior, posterior);
    summary.discrepancies = discrepancies_in(request_.out / "likelihood.json");
    write_text(request_.out / "posterior.csv", posterior_csv(draws, posterior));
    journal_["batches"] = std::move(journal_["made"]);
    journal_.erase("made");
    journal_["prior"] = values_json(prior);
    journal_["summary"] = json_of(summary);
    write_text(file_, journal_.dump() + "\n");
    std::vector<std::string> best = request_.set;
    for (const std::string& value : most_probable.values_of(0, "")) best.push_back(value);
    best.emplace_back("ensemble.members=0");
    std::vector<std::string> lines{fmt::format("The most probable of {} runs:", own.runs())};
    for (const std::string& line : table_lines(summary)) lines.push_back(line);
    fitted_.write(best, lines);
    for (const std::string& line : table_lines(summary)) log_info(line);
    for (const std::string& sentence : conclusions(summary)) log_info(sentence);
    print_results({fitted_.file(), request_.out / "posterior.csv", file_});
    return own.members_at(draws.places);
  }

 private:
  const Request& request_;
  FittedRecipe fitted_;
  fs::path file_;
  EnsembleOptions options_;
  std::vector<std::string> keys_;
  double factor_ = 1;
  Json journal_;
};

}  // namespace

int calibrate_scene(const Request& request) {
  require_tables(request);
  Calibration calibration(request);
  make_folder(request.out);
  Request members;
  try {
    const OutputLock lock(request.out, "talus calibrate");
    members = calibration.run();
  } catch (const StageFailed& failed) {
    return report_faults("talus calibrate", failed.outcome);
  }
  return run_scene(members);
}

}  // namespace talus::command
