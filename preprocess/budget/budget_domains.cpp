// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/budget/budget_domains.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/domain/domain_facts.hpp"
#include "common/stage/findings.hpp"

namespace talus::preprocess {
namespace {

namespace fs = std::filesystem;

/// Domains beside the run's, made one after another.
class BudgetDomains {
 public:
  BudgetDomains(StageContext& context, const BudgetOptions& options, const EnsembleBase& base, const Domain& domain)
      : context_(context), options_(options), base_(base), domain_(domain), paths_{context.out} {}

  void make_all();

 private:
  /// What a domain is made from.
  struct Wanted {
    std::string name, difference;
    std::vector<std::string> values;  ///< that make it by hand
  };
  void cells();
  void surveys();
  template <class Make>
  void make(const Wanted& wanted, const Make& prepared);
  template <class Make>
  std::optional<Prepared> tried(const std::string& name, const Make& prepared);
  void write(const Wanted& wanted, Prepared&& made, Facts marks);
  bool is_there(const std::string& name, const Facts& marks) const;
  void leave_out(const std::string& name, const std::string& why);

  StageContext& context_;
  const BudgetOptions& options_;
  const EnsembleBase& base_;
  const Domain& domain_;
  BudgetPaths paths_;
  std::string told_;
};

bool BudgetDomains::is_there(const std::string& name, const Facts& marks) const {
  const fs::path file = paths_.domain(name);
  try {
    if (!fs::exists(file)) return false;
    const Facts facts = domain_facts(file);
    return fact(facts, domain_id) == fact(marks, domain_id) && fact(facts, budget_base) == fact(base_.marks, domain_id);
  } catch (const DataError&) {  // damaged: made again
    return false;
  }
}

void BudgetDomains::leave_out(const std::string& name, const std::string& why) {
  warn("budget-domain-missing", fmt::format("budget: no domain \"{}\": {}", name, why));
  told_ += fmt::format("{}: left out: {}\n", name, why);
  remove_for_good(paths_.domain(name));
}

void BudgetDomains::write(const Wanted& wanted, Prepared&& made, Facts marks) {
  marks.emplace_back(budget_base, fact(base_.marks, domain_id));
  marks.emplace_back(budget_values, fmt::format("{}", fmt::join(wanted.values, "\n")));
  Domain& domain = made.domain;
  domain.provenance = provenance_of(context_, base_.inputs, marks, facts_of(made));
  domain.provenance.insert(domain.provenance.end(), base_.checksums.begin(), base_.checksums.end());
  domain.obstacles = base_.obstacles;
  write_domain(paths_.domain(wanted.name), domain);
}

template <class Make>
void BudgetDomains::make(const Wanted& wanted, const Make& prepared) {
  stop_if_interrupted(fmt::format("making the domain \"{}\" of the budget", wanted.name));
  const Facts marks = marks_of(context_.recipe, base_.inputs, "budget " + wanted.difference);
  if (!is_there(wanted.name, marks)) {
    auto made = tried(wanted.name, prepared);
    if (!made) return;
    write(wanted, std::move(*made), marks);  // a fault of the disk ends the stage
  }
  told_ += wanted.name + ": made\n";
  context_.results.push_back(paths_.domain(wanted.name));
}

/// The domain, none where this scene does not allow for it: then it is left out with the reason.
template <class Make>
std::optional<Prepared> BudgetDomains::tried(const std::string& name, const Make& prepared) {
  std::optional<Prepared> made;
  std::vector<Finding> warnings;
  try {
    const Findings found("preprocess", {}, Findings::Log::kept_back);
    made.emplace(prepared());
    warnings = found.list();
  } catch (const RecipeError& error) {
    leave_out(name, error.what());
  } catch (const DataError& error) {
    require_unchanged(base_.inputs);
    leave_out(name, error.what());
  }
  for (const Finding& found : warnings) warn(found.name, fmt::format("budget, {}: {}", name, found.message));
  return made;
}

void BudgetDomains::cells() {
  const double spacing = options_.cell_factor * domain_.grid.cell, layers = options_.cell_factor * domain_.layer_height;
  const std::vector<std::string> values{fmt::format("preprocess.grid.spacing_m={}", spacing),
                                        fmt::format("preprocess.grid.layer_height_m={}", layers)};
  make({"cells", fmt::format("{}", fmt::join(values, " ")), values}, [&] {
    const auto options = context_.recipe.with(values).read<Options>("preprocess");
    return prepare(resolved(options), read_scene(options, &base_.memory), Points::seeded);
  });
}

void BudgetDomains::surveys() {
  ElevationErrorOptions error = options_.elevation_error;
  if (!error.acts()) error.from_survey = true;
  const auto refuse_all = [&](const std::string& why) {
    for (int draw = 1; draw <= options_.survey_draws; ++draw) leave_out(survey_draw_name(draw), why);
  };
  if (error.from_survey && !base_.scene.survey)
    return refuse_all("the recipe compares no two surveys, and [budget.elevation_error] gives no numbers");
  if (error.from_survey && !base_.scene.survey->errors.is_known())
    return refuse_all("the error of the survey is not known, and [budget.elevation_error] gives no numbers");
  std::optional<ElevationErrors> errors;
  try {
    errors.emplace(error, base_.options, base_.scene, options_.seed, "budget.elevation_error");
  } catch (const RecipeError& refused) {
    return refuse_all(refused.what());
  }
  log_info("budget, " + errors->words());
  for (int draw = 1; draw <= options_.survey_draws; ++draw)
    make({survey_draw_name(draw),
          fmt::format("{}seed {} draw {}", recipe::to_toml(error, "error", false), options_.seed, draw),
          {}},
         [&] {
           SceneRasters scene = base_.scene;
           errors->apply(scene, draw);
           return prepare(resolved(base_.options), std::move(scene), Points::seeded);
         });
}

void BudgetDomains::make_all() {
  make_folder(paths_.folder());
  if (options_.has("cells")) cells();
  if (options_.has("survey")) surveys();
  write_text(paths_.domains(), told_);
  context_.results.push_back(paths_.domains());
}

/// The files of domains in the folder of a budget.
std::vector<fs::path> domains_in(const BudgetPaths& paths) {
  static const std::regex of_a_budget(R"(domain\.(cells|survey-[0-9]{1,3})\.vdb)");
  std::vector<fs::path> files;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(paths.folder(), unreadable))
    if (std::regex_match(entry.path().filename().string(), of_a_budget)) files.push_back(entry.path());
  return files;
}

}  // namespace

void write_budget_domains(StageContext& context, const BudgetOptions& options, const EnsembleBase& base,
                          const Domain& domain) {
  const BudgetPaths paths{context.out};
  std::set<fs::path> wanted;
  if (options.has("cells")) wanted.insert(paths.domain("cells"));
  for (int draw = 1; draw <= options.survey_draws && options.has("survey"); ++draw)
    wanted.insert(paths.domain(survey_draw_name(draw)));
  for (const fs::path& file : domains_in(paths))
    if (!wanted.contains(file)) remove_for_good(file);
  BudgetDomains(context, options, base, domain).make_all();
}

void remove_budget_domains(const BudgetPaths& paths) {
  for (const fs::path& file : domains_in(paths)) remove_for_good(file);
  remove_for_good(paths.domains());
  std::error_code not_empty;
  fs::remove(paths.folder(), not_empty);
}

}  // namespace talus::preprocess
