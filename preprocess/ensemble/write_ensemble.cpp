// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <regex>

#include "common/domain/domain.hpp"
#include "common/domain/threads.hpp"
#include "common/ensemble/used.hpp"
#include "common/error.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/machine.hpp"
#include "preprocess/ensemble/ensemble.hpp"

namespace talus::preprocess {
namespace {

namespace fs = std::filesystem;

/// The faults of a member, told with its number or name.
template <class Kind>
std::vector<Fault> with_member(const Kind& error, const MemberTable& table, std::int64_t member) {
  std::vector<Fault> faults = error.faults();
  for (Fault& fault : faults)
    fault.what = fmt::format("[{}] {}: {}", table.slides ? "slides" : "ensemble", table.name_of(member), fault.what);
  return faults;
}

/// The members' domains while they are made: shared by threads.
class MemberDomains {
 public:
  MemberDomains(const StageContext& context, const EnsemblePlan& plan, const EnsembleBase& base)
      : context_(context), plan_(plan), base_(base), paths_{context.out} {
    for (std::int64_t k = 0; k < plan.table.count; ++k)
      if (plan.table.own_domain[static_cast<std::size_t>(k)]) todo_.push_back(k);
    points_.assign(static_cast<std::size_t>(plan.table.count), -1);
  }

  void make_all() {
    if (todo_.empty()) return;
    make_folder(paths_.folder());
    const auto began = std::chrono::steady_clock::now();
    {
      const std::size_t limit = static_cast<std::size_t>(std::max(thread_limit(), 1)),
                        count = std::min({todo_.size(), limit, most_threads_that_write});
      const ThreadsOfLibraries who_is_left(static_cast<int>(limit - count) + 1);
      in_threads(
          todo_.size(), "making the domains of members; those that are finished are kept",
          [this](std::size_t place) { work(todo_[place]); }, most_threads_that_write);
    }
    if (!faults_.empty()) throw DataError(std::move(faults_));
    say_failures();
    say_end(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }

  /// The members whose domain cannot be made, in order.
  std::vector<MemberWords> failures() const {
    std::vector<MemberWords> all;
    for (const auto& [member, words] : failures_) all.push_back({member, words});
    return all;
  }

  /// What a member's domain says of itself, whose `domain.id` follows from all that it is made of.
  Facts marks_of_member(std::int64_t member) const {
    return marks_of(context_.recipe, base_.options, inputs_of_member(member), difference_of(member));
  }

  /// The number of material points in the domains, by member; of those that were there it is read.
  std::vector<std::int64_t> points() const {
    std::vector<std::int64_t> all = points_;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k] < 0)
        all[k] = std::stoll(fact(domain_facts(paths_.domain(static_cast<std::int64_t>(k))), "material_points"));
    return all;
  }

 private:
  void work(std::int64_t member) {
    if (stop_) return;
    try {
      make(member);
    } catch (const RecipeError& error) {
      throw RecipeError(with_member(error, plan_.table, member));
    } catch (const DataError& error) {
      if (!plan_.table.slides) throw DataError(with_member(error, plan_.table, member));
      return note_faults(with_member(error, plan_.table, member));
    }
    const std::lock_guard lock(mutex_);
    if (progress_.due()) progress_.update(fmt::format("domains of members {}/{}", made_ + kept_, todo_.size()));
  }

  void make(std::int64_t member) {
    const Facts inputs = inputs_of_member(member);
    Facts marks = marks_of(context_.recipe, base_.options, inputs, difference_of(member));
    const fs::path file = paths_.domain(member);
    if (is_there(file, marks)) {
      ++kept_;
      return;
    }
    const Findings found("preprocess", {}, Findings::Log::kept_back);
    std::optional<Prepared> made = prepared_or_failed(member, inputs);
    if (!made) {
      remove_for_good(file);  // of an ensemble before
      return;
    }
    if (plan_.table.rows.empty()) check_grid(member, *made);  // deposits of a budget may be on other cells
    points_[static_cast<std::size_t>(member)] = static_cast<std::int64_t>(made->point_count);
    if (plan_.table.slides)
      marks.emplace_back("slide", plan_.table.name_of(member));
    else
      marks.emplace_back("ensemble.base", fact(base_.marks, domain_id));
    marks.emplace_back("ensemble.member", std::to_string(member));
    for (const std::string& value : values_of(member)) {
      const auto sign = value.find('=');
      marks.emplace_back("ensemble." + value.substr(0, sign), value.substr(sign + 1));
    }
    Facts& provenance = made->domain.provenance;
    provenance = provenance_of(context_, inputs, marks, facts_of(*made));
    provenance.insert(provenance.end(), base_.checksums.begin(), base_.checksums.end());
    made->domain.obstacles = base_.obstacles;
    write_domain(file, made->domain);
    ++made_;
    note_warnings(member, found.list());
  }

  bool is_there(const fs::path& file, const Facts& marks) const {
    try {
      return fs::exists(file) && fact(domain_facts(file), domain_id) == fact(marks, domain_id);
    } catch (const DataError&) {  // damaged: made again
      return false;
    }
  }

  /// What tells a member's domain from the base's: its values, and its field.
  std::string difference_of(std::int64_t member) const {
    std::string text = fmt::format("{}", fmt::join(values_of(member), "\n"));
    if (const auto field = plan_.field_of(member))
      text += fmt::format("\n{}\nseed {}, member {}", recipe::to_toml(plan_.options.elevation_error, "error", false),
                          plan_.table.seed, *field);
    return text;
  }

  Prepared prepared(std::int64_t member) const {
    const auto& own = plan_.ground[static_cast<std::size_t>(member)];
    const Options& options = own ? *own : base_.options;
    SceneRasters scene = own ? read_scene(options, &base_.memory) : base_.scene;
    if (const auto field = plan_.field_of(member)) plan_.errors->apply(scene, *field);
    Options made_with = resolved(options);
    if (plan_.table.find(thickness_factor_key) != nullptr) made_with.thickness_factor = 1;
    return prepare(made_with, std::move(scene), Points::seeded);
  }

  std::optional<Prepared> prepared_or_failed(std::int64_t member, const Facts& inputs) {
    if (plan_.table.slides) return prepared(member);
    try {
      return prepared(member);
    } catch (const DataError& error) {
      require_unchanged(inputs);
      note_failure(member, error.what());
    } catch (const RecipeError& error) {
      note_failure(member, error.what());
    }
    return std::nullopt;
  }

  void check_grid(std::int64_t member, const Prepared& made) const {
    const MapGrid& own = made.domain.grid;
    const MapGrid base = plan_.table.slides ? cut(plan_.table.slides->lattice,
                                                  plan_.table.slides->windows[static_cast<std::size_t>(member)])
                                            : base_.scene.bed.grid;
    const auto words = [](const MapGrid& g) {
      return fmt::format("{} x {} cells of {:g} m from {:.10g}, {:.10g}", g.columns, g.rows, g.cell, g.west, g.south);
    };
    if (words(own) == words(base) && own.crs_wkt == base.crs_wkt) return;
    if (plan_.table.slides)
      throw DataError({fmt::format("its grid is {}, and its window {}", words(own), words(base)),
                       "the model has no data along the window's edge, or lies slanting in the working CRS",
                       "Fill the model, or bring it to the working CRS beforehand (gdalwarp)"});
    throw DataError({fmt::format("it lies on another grid: {} (the base: {})", words(own), words(base)),
                     "members are counted in the cells of one map",
                     "Name the part to compute, so that all have it: extent_m in "
                     "[preprocess.grid]"});
  }

  void note_warnings(std::int64_t member, const std::vector<Finding>& findings) {
    static const std::regex number("[0-9][0-9.,e+-]*");
    const std::lock_guard lock(mutex_);
    for (const Finding& finding : findings) {
      if (std::ranges::find(base_.scene.findings, finding) != base_.scene.findings.end()) continue;
      const std::string& warning = finding.message;
      const std::string kind = std::regex_replace(warning, number, "#");
      auto [found, is_new] = warnings_.try_emplace(kind, member, 0);
      ++found->second.second;
      if (is_new) first_words_[kind] = warning;
    }
  }

  void note_faults(std::vector<Fault> faults) {
    constexpr std::size_t most = 20;
    const std::lock_guard lock(mutex_);
    for (Fault& fault : faults)
      if (faults_.size() < most) faults_.push_back(std::move(fault));
  }

  void note_failure(std::int64_t member, std::string words) {
    const std::lock_guard lock(mutex_);
    failures_.emplace(member, std::move(words));
    if (too_many_failed()) stop_ = true;
  }

  void say_failures() const {
    constexpr std::size_t most = 5;
    std::size_t said = 0;
    for (const auto& [member, words] : failures_)
      if (++said <= most)
        warn("member-without-domain", fmt::format("{} is left out: {}", plan_.table.name_of(member), words));
    if (said == 0) return;
    warn("members-without-domain",
         fmt::format("{} of {} members have no domain: talus-solve {}", said, plan_.table.count,
                     plan_.options.is_budget() ? "leaves them out" : "counts them as failed"));
    if (too_many_failed())
      throw DataError(
          plan_.options.too_many_failed(fmt::format("[ensemble]: {} of {} members have no domain, the first is {}",
                                                    said, plan_.table.count, failures_.begin()->first),
                                        failures_.begin()->second));
  }

  bool too_many_failed() const {
    return static_cast<double>(failures_.size()) > plan_.options.may_fail(plan_.table.count);
  }
  void say_end(double seconds) const {
    for (const auto& [kind, members] : warnings_)
      warn("members-warn",
           fmt::format("{}{}: {}", plan_.table.name_of(members.first),
                       members.second > 1 ? fmt::format(" and {} others likewise", members.second - 1) : "",
                       first_words_.at(kind)));
    double bytes = 0;
    for (const std::int64_t k : todo_)
      if (!failures_.contains(k)) bytes += static_cast<double>(fs::file_size(paths_.domain(k)));
    log_info(fmt::format("domains of members: {} made in {:.3g} s, {} were there; {:.1f} MB in {}", made_.load(),
                         seconds, kept_.load(), bytes * 1e-6, paths_.folder().string()));
  }

  /// The values of [preprocess] by which a member differs.
  std::vector<std::string> values_of(std::int64_t member) const {
    return plan_.own_values.empty() ? ground_of(plan_.table, member)
                                    : plan_.own_values[static_cast<std::size_t>(member)];
  }
  Facts inputs_of_member(std::int64_t member) const {
    const auto& own = plan_.ground[static_cast<std::size_t>(member)];
    return own && !plan_.table.slides ? checksums_of(inputs_of(*own)) : base_.inputs;
  }

  const StageContext& context_;
  const EnsemblePlan& plan_;
  const EnsembleBase& base_;
  EnsemblePaths paths_;
  std::vector<std::int64_t> todo_;
  std::atomic<std::int64_t> made_{0}, kept_{0};
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Fault> faults_;                     // of slides, of which all are told
  std::map<std::int64_t, std::string> failures_;  // of an ensemble, whose other members are made
  std::vector<std::int64_t> points_;
  std::map<std::string, std::pair<std::int64_t, std::int64_t>> warnings_;  // text without numbers: first member, count
  std::map<std::string, std::string> first_words_;
  Progress progress_;
};

/// Says how many material points slides have; the slide with the most.
std::int64_t say_points(const std::vector<std::int64_t>& points, const MemberTable& table) {
  const auto largest = std::max_element(points.begin(), points.end());
  Sum all;
  for (const std::int64_t count : points) all.add(static_cast<double>(count));
  log_info(fmt::format("material points: {} in all, {} in {}, the most of a slide", grouped(all.value()),
                       grouped(static_cast<double>(*largest)), table.name_of(largest - points.begin())));
  return largest - points.begin();
}

}  // namespace

std::int64_t write_ensemble(StageContext& context, EnsemblePlan& plan, const EnsembleBase& base) {
  const EnsemblePaths paths{context.out};
  MemberTable& table = plan.table;
  remove_members(paths, &plan);
  MemberDomains domains(context, plan, base);
  domains.make_all();
  for (MemberWords& failure : domains.failures()) add_in_order(table.failures, std::move(failure));
  std::int64_t largest = 0;
  std::string of_base = fact(base.marks, domain_id);
  if (table.slides) {
    for (std::int64_t k = 0; k < table.count; ++k)
      table.slides->domains.push_back(fact(domains.marks_of_member(k), domain_id));
    largest = say_points(domains.points(), table);
    of_base = table.slides->domains[static_cast<std::size_t>(largest)];
  }
  table.provenance = {{"version", version()},
                      {"command", context.command_line},
                      {recipe_of_members, recipe_mark(context.recipe, "ensemble")},
                      {recipe_of_slides, recipe_mark(context.recipe, "slides")},
                      {used_by_members, ensemble_mark(context.recipe)},
                      {base_domain_id, of_base}};
  if (!plan.options.prior_source.empty()) table.provenance.emplace_back(prior_of_members, plan.options.prior_source);
  if (plan.errors) table.provenance.emplace_back(elevation_error_of_members, plan.errors->words());
  write_member_table(paths.members(), table);
  context.results.push_back(paths.members());
  return largest;
}

}  // namespace talus::preprocess
