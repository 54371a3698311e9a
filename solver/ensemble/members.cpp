// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/members.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/ensemble/options.hpp"
#include "common/stage/stage.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/run/simulation.hpp"

namespace talus::solver {
namespace {

constexpr const char* settling_keys[] = {"solve.material.stiffness",
                                         "solve.material.youngs_modulus_Pa",
                                         "solve.accuracy",
                                         "solve.integrator",
                                         "solve.cfl",
                                         "solve.preset"};

bool varies_settling(const MemberTable& table) {
  return table.slides || std::any_of(std::begin(settling_keys), std::end(settling_keys),
                                     [&](const char* key) { return table.find(key) != nullptr; });
}

/// Whether a member's maps can be counted: on the grid of the base domain, of a slide on its window of the lattice.
bool is_countable(const MapGrid& own, const MemberTable& table, std::int64_t member, const MapGrid& base) {
  if (!table.slides) return own.has_cells_of(base);
  return window_on(table.slides->lattice, own) == table.slides->windows[static_cast<std::size_t>(member)];
}

SolveOptions settled_by(const SettledOnce& settled, SolveOptions options) {
  if (!options.map_threshold) options.map_threshold = settled.map_threshold;
  if (settled.stiffness && leaves_stiffness(options)) options = with_stiffness(std::move(options), *settled.stiffness);
  if (settled.steps && options.integrator == Integrator::automatic)
    options = with_steps(std::move(options), *settled.steps);
  return options;
}

SettledOnce settled_once(const Plan& base) {
  SettledOnce settled;
  const SolveOptions &asked = base.asked, &used = base.options;
  if (leaves_stiffness(asked)) settled.stiffness.emplace().modulus = used.material.youngs_modulus;
  if (asked.integrator == Integrator::automatic)
    settled.steps = StepChoice{.flow = used.flow,
                               .cfl = used.step_over_cfl(),
                               .rests = used.integrator == Integrator::automatic,
                               .reasons = {}};
  return settled;
}

/// The base's plan without its points; what was settled is logged.
Plan settled_base(std::shared_ptr<const Domain> domain, const SolveOptions& options) {
  Plan base = begin_plan(std::move(domain), options);
  settle(base);
  for (const std::string& reason : base.reasons) log_info(reason);
  warn_of_unkept_accuracy(*base.domain, base.asked, base.bound.line);
  return base;
}

}  // namespace

Members::Members(const recipe::Recipe& recipe, const MemberTable& table, const EnsemblePaths& paths,
                 std::shared_ptr<const Domain> domain, const SolveOptions& options)
    : recipe_(recipe), table_(table), paths_(paths), domain_(std::move(domain)), settles_each_(varies_settling(table)) {
  Plan base = settled_base(domain_, options);
  if (!settles_each_) settled_ = settled_once(base);
  settled_.map_threshold = base.options.map_threshold;
  vary(base);
  base_ = std::move(base.options);
}

void Members::vary(const Plan& base) {
  if (table_.rows.empty()) return;
  variations_ = variations_of(table_, base, ensemble_of(recipe_).budget, [&](const std::vector<std::string>& values) {
    return settled_by(settled_, with_places(solver::options_of(recipe_.with(values), paths_.out), base.domain->places));
  });
  constexpr std::string_view of_domain = "ensemble.";  // facts of what a domain was made with
  for (std::int64_t member = 0; member < table_.count; ++member) {
    Variation& one = variations_[static_cast<std::size_t>(member)];
    if (const MemberWords* failure = table_.failure_of(member)) one.left_out = failure->words;
    const std::filesystem::path file = paths_.domain(member);
    if (one.left_out || table_.own_domain[static_cast<std::size_t>(member)] == 0 || !std::filesystem::exists(file))
      continue;
    for (const auto& [name, value] : domain_facts(file))
      if (name.starts_with("ensemble.preprocess.")) one.values.push_back(name.substr(of_domain.size()) + "=" + value);
  }
}

void Members::note_changes(EnsembleCounts& counts) const {
  for (std::int64_t member = counts.part.first; member < counts.part.end && !variations_.empty(); ++member) {
    const Variation& one = variations_[static_cast<std::size_t>(member)];
    if (one.left_out) counts.leave_out(member, *one.left_out);
    if (!one.words.empty())
      add_in_order(counts.changes, {member, fmt::format("{}\n{}", one.words, fmt::join(one.values, "\n"))});
  }
}

SolveOptions Members::options_of(std::int64_t member) const {
  try {
    return solver::options_of(recipe_.with(table_.values_of(member, "solve.")), paths_.out);
  } catch (const RecipeError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults) fault.what = fmt::format("member {}: {}", member, fault.what);
    throw RecipeError(std::move(faults));
  }
}

void Members::check() const {
  for (std::size_t k = 0; k < variations_.size(); ++k) {
    const Variation& one = variations_[k];
    if (!one.words.empty())
      log_info(fmt::format("  {:<14} {}", table_.names[k], one.left_out ? "left out: " + *one.left_out : one.words));
  }
  if (!variations_.empty()) return;  // they have been read
  for (std::int64_t member = 0; member < table_.count; ++member) {
    stop_if_interrupted("checking the members");
    options_of(member);
  }
}

std::shared_ptr<const Domain> Members::domain_of(std::int64_t member) const {
  if (const MemberWords* failure = table_.failure_of(member)) throw DataError({failure->words, "", ""});
  const bool own = table_.own_domain.at(static_cast<std::size_t>(member)) != 0;
  const MemberColumn* factor = table_.find(thickness_factor_key);
  const BedChange* bed = variations_.empty() ? nullptr : &variations_[static_cast<std::size_t>(member)].change_bed;
  const bool bed_changes = bed != nullptr && *bed;
  if (!own && factor == nullptr && !bed_changes) return domain_;
  Domain domain = own ? read_domain(paths_.domain(member)) : *domain_;
  if (bed_changes) domain = with_bed(std::move(domain), *bed);
  if (own && variations_.empty() && !is_countable(domain.grid, table_, member, domain_->grid))
    throw DataError(
        {paths_.domain(member).string() + (table_.slides ? ": its grid is not the window that members.h5 has for it"
                                                         : ": its grid is not that of the base domain"),
         "maps of several grids cannot be counted together",
         "Leave keys that change the grid as they are in all members, and run talus-preprocess again"});
  if (factor != nullptr) scale_release(domain, factor->values.at(static_cast<std::size_t>(member)));
  return std::make_shared<const Domain>(std::move(domain));
}

std::shared_ptr<const Plan> Members::plan(std::int64_t member) const {
  const std::shared_ptr<const Domain> domain = domain_of(member);
  if (!variations_.empty())
    return solver::plan(domain, variations_[static_cast<std::size_t>(member)].options, Settle::done);
  SolveOptions options;
  {
    const std::lock_guard<std::mutex> one(reading_);
    options = with_places(options_of(member), domain->places);
  }
  options = settled_by(settled_, std::move(options));
  return solver::plan(domain, options, settles_each_ ? Settle::as_asked : Settle::done);
}

}  // namespace talus::solver
