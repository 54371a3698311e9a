// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/ensemble_stage.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/ensemble/counts.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/signals.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/run_members.hpp"
#include "solver/run/simulation.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

constexpr int most_at_a_time = 1000;  ///< each has a thread of its own
constexpr std::size_t most_said = 5;  ///< failures and warnings in the log; all stand in the counts

/// All that an ensemble is made of, once it is read.
struct Ensemble {
  EnsembleOptions options;
  EnsemblePaths paths;
  MemberTable table = {};
  MemberRange part = {};
  std::string fingerprint = {};
  std::filesystem::path counts = {};  ///< the result
  bool edge_fails = false;
};

/// What identifies the counts of an ensemble: members, domain, settings and thresholds.
std::string fingerprint_of_members(const Ensemble& e, const std::filesystem::path& domain, const SolveOptions& base) {
  std::string text = fingerprint_of(domain, base) + recipe::to_toml(e.options.thresholds, "thresholds", false);
  for (std::int64_t member = 0; member < e.table.count; ++member) {
    for (const std::string& value : e.table.values_of(member, "")) text += value + "\n";
    text += e.table.own_domain[static_cast<std::size_t>(member)] != 0 ? "own\n" : "\n";
  }
  for (const MemberWords& failure : e.table.failures) text += fmt::format("{} has no domain\n", failure.member);
  if (e.edge_fails) text += "who comes to an edge fails\n";
  if (e.options.keeps("deposits")) text += "deposits are kept\n";
  if (e.options.is_budget()) text += recipe::to_toml(e.options.budget, "budget", false);
  text += fact(e.table.provenance, elevation_error_of_members);
  if (e.table.slides)
    for (const std::string& id : e.table.slides->domains) text += id + "\n";
  text += fact(e.table.provenance, base_domain_id) + fmt::format(" {} {}", e.table.design, e.table.seed);
  return sha256_of_text(text);
}

/// Refuses members that were drawn for another [ensemble] or domain.
void judge_table(const StageContext& context, const Ensemble& e, const Domain& domain) {
  judge_members(context.recipe, e.paths.members(), e.table);
  const std::string of = fact(e.table.provenance, base_domain_id), is = fact(domain.provenance, domain_id);
  if (of != is)
    throw DataError({e.paths.members().string() + ": its members differ from another domain",
                     fmt::format("it names domain {}, domain.vdb is {}", of, is), "Run talus-preprocess again"});
}

Ensemble read_ensemble(const StageContext& context, const EnsembleFlags& flags, const Domain& domain,
                       const SolveOptions& base) {
  Ensemble e{.options = ensemble_of(context.recipe),
             .paths = {context.out},
             .edge_fails = slides_of(context.recipe).at_edge == SlideAtEdge::fail};
  e.table = read_member_table(e.paths.members());
  judge_table(context, e, domain);
  e.part = flags.members.value_or(MemberRange{0, e.table.count});
  if (e.part.end > e.table.count)
    throw RecipeError({fmt::format("--members {}:{}", e.part.first, e.part.end),
                       fmt::format("there are {} members, counted from 0", e.table.count), "Name some that are there"});
  e.counts = flags.members ? e.paths.counts(e.part) : e.paths.counts();
  e.fingerprint = fingerprint_of_members(e, inputs_of(base, context.out).front(), base);
  return e;
}

EnsembleCounts fresh_counts(const StageContext& context, const Ensemble& e, const Domain& domain,
                            const SolveOptions& base) {
  EnsembleScene scene;
  scene.scene = context.recipe.scene_name();
  scene.title = context.recipe.title();
  scene.threshold = base.map_threshold.value();
  scene.grid = e.table.slides ? e.table.slides->lattice : domain.grid;
  if (!e.table.slides) {
    scene.terrain = domain.terrain.values;
    scene.before = domain.before.values;
    scene.release_thickness = domain.release_thickness.values;
  }
  const bool budget = e.options.is_budget();  // of which deposits are compared, and nothing is counted
  if (e.table.slides || budget) scene.tallied = Tallied::largest;
  EnsembleCounts counts = empty_counts(std::move(scene), e.table.count, e.part,
                                       budget ? ThresholdOptions{{}, {}, {}, {}, {}} : e.options.thresholds);
  counts.fingerprint = e.fingerprint;
  counts.provenance = domain.provenance;
  const Facts own = made_by(context, base);
  counts.provenance.insert(counts.provenance.end(), own.begin(), own.end());
  counts.provenance.emplace_back("version.solve", version());
  counts.findings = findings_so_far();
  return counts;
}

/// What is finished of this very part, none where nothing is.
std::optional<EnsembleCounts> finished_of(const std::filesystem::path& file, const Ensemble& e) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  EnsembleCounts counts = read_counts(file);
  if (counts.fingerprint != e.fingerprint || !(counts.part == e.part)) return std::nullopt;
  return counts;
}

/// This function takes up what an interrupted computation of this part has finished, as the flags ask for.
void take_up(const Ensemble& e, const EnsembleFlags& flags, EnsembleCounts& counts) {
  const auto file = e.paths.unfinished(e.part);
  auto found = finished_of(file, e);
  if (!found) {
    if (flags.restart)
      throw DataError({file.string() + (std::filesystem::exists(file) ? ": of another ensemble" : ": no such file"),
                       "there is nothing to go on from", "Leave --restart out"});
    return;
  }
  const std::int64_t done = found->part.count() - found->count(MemberState::waiting);
  if (!flags.restart && !flags.resume)
    throw DataError({fmt::format("{}: it holds {} finished members of this very ensemble", file.string(), done),
                     "a run from the start would throw them away",
                     "Go on from it with --restart, or remove it to begin anew"});
  log_info(fmt::format("going on from {}: {} of {} members are finished", file.string(), done, found->part.count()));
  counts = std::move(*found);
}

/// This function says what members found, each once with the members that it is of: refusals that the recipe overrides
/// by their names, warnings by their words.
void say_findings(const EnsembleCounts& counts, const MemberTable& table) {
  std::vector<std::pair<Finding, std::vector<std::int64_t>>> said;
  for (const Finding& finding : counts.findings) {
    if (finding.member == Finding::no_member) continue;
    const bool by_name = finding.severity == Severity::refusal;
    auto same = std::ranges::find_if(said, [&](const auto& one) {
      return one.first.name == finding.name && (by_name || one.first.message == finding.message);
    });
    if (same == said.end()) same = said.insert(by_name ? said.begin() : said.end(), {finding, {}});
    same->second.push_back(finding.member);
  }
  for (std::size_t n = 0; n < said.size() && n < most_said; ++n) {
    auto& [finding, members] = said[n];
    finding.message =
        fmt::format("{}{}: {}", table.name_of(members.front()),
                    members.size() == 1 ? "" : fmt::format(" and {} others", members.size() - 1), finding.message);
    add_finding(finding);
  }
  if (said.size() > most_said)
    warn("more-findings", fmt::format("{} more warnings of members", said.size() - most_said));
}

/// This function saves what is finished, and throws Interrupted.
[[noreturn]] void stop(const EnsembleCounts& counts, const std::filesystem::path& unfinished) {
  write_counts(unfinished, counts);
  throw Interrupted({fmt::format("stopped with {} of {} members finished",
                                 counts.part.count() - counts.count(MemberState::waiting), counts.part.count()),
                     "interrupted", fmt::format("Go on with --restart; {} holds them", unfinished.string())});
}

/// This function says which members failed; it throws NumericalError where they are too many.
void judge_failures(const EnsembleCounts& counts, const Ensemble& e) {
  std::vector<MemberWords> failures = counts.failures;
  std::erase_if(failures, [&](const MemberWords& one) { return counts.state_of(one.member) == MemberState::left_out; });
  for (std::size_t n = 0; n < failures.size() && n < most_said; ++n)
    warn("member-failed", fmt::format("{} failed: {}", e.table.name_of(failures[n].member), failures[n].words));
  const auto failed = static_cast<double>(failures.size());
  if (failed == 0) return;
  warn("members-failed", fmt::format("{} of {} members failed; the counts are without them", failed, e.part.count()));
  if (failed <= e.options.may_fail(counts.members - counts.count(MemberState::left_out))) return;
  throw NumericalError(e.options.too_many_failed(fmt::format("{:.0f} of {} members failed, the first is {}", failed,
                                                             e.part.count(), e.table.name_of(failures.front().member)),
                                                 failures.front().words));
}

/// This function names the members that came to the edge of their domain.
void say_edges(const EnsembleCounts& counts, const MemberTable& table) {
  const std::vector<std::int64_t> members = counts.at_edge();
  if (members.empty()) return;
  warn("members-at-edge",
       fmt::format("{} of {} members came to the edge of their domain ({}): what lies beyond is missing from "
                   "maps and numbers. {}",
                   members.size(), counts.part.count(), table.names_of(members, most_said),
                   table.slides ? "Give a larger margin_m in [slides], or a smaller reach_angle_deg"
                                : "Take a larger part of the elevation model"));
}

/// Runs the members of a part that wait, on these devices, and saves their counts now and then; see run_members().
bool count_members(const Ensemble& e, const Members& members, const std::vector<AnyDevice>& devices,
                   EnsembleCounts& counts) {
  return run_members(members, counts,
                     {.devices = devices,
                      .save = [&] { write_counts(e.paths.unfinished(e.part), counts); },
                      .edge_fails = e.edge_fails});
}

}  // namespace

MemberRange member_range(const std::string& words) {
  MemberRange range;
  const char *at = words.data(), *end = words.data() + words.size();
  const auto first = std::from_chars(at, end, range.first);
  const bool colon = first.ec == std::errc{} && first.ptr != end && *first.ptr == ':';
  const auto last = colon ? std::from_chars(first.ptr + 1, end, range.end) : first;
  if (!colon || last.ec != std::errc{} || last.ptr != end || range.first < 0 || range.end <= range.first)
    throw RecipeError({"--members " + words, "this is no range of members",
                       "Write the first and the one after the last, counted from 0: --members 0:250"});
  return range;
}

int members_at_a_time(const std::string& words) {
  int count = 0;
  const char* const end = words.data() + words.size();
  const auto read = std::from_chars(words.data(), end, count);
  if (read.ec != std::errc{} || read.ptr != end || count < 1 || count > most_at_a_time)
    throw RecipeError({"--at-a-time " + words, "this is no number of members",
                       fmt::format("Write one from 1 to {}", most_at_a_time)});
  return count;
}

Dependencies depends_of_ensemble(const StageContext& context, const EnsembleFlags& flags) {
  const EnsemblePaths paths{context.out};
  auto inputs = inputs_of(options_of(context.recipe, context.out), context.out);
  inputs.push_back(paths.members());
  return {{flags.members ? paths.counts(*flags.members) : paths.counts()}, inputs};
}

Facts run_ensemble(StageContext& context, const EnsembleFlags& flags, const std::shared_ptr<const Domain>& base_domain,
                   const SolveOptions& base) {
  const Findings found("solve");
  const Domain& domain = *base_domain;
  const RunTimer timer;
  const Ensemble e = read_ensemble(context, flags, domain, base);
  const auto seconds = [&] { return fmt::format("{:.3f}", timer.seconds()); };
  if (!flags.plan && !context.check_only && finished_of(e.counts, e)) {
    log_info(fmt::format("{}: it holds this very part already", e.counts.string()));
    context.results.push_back(e.counts);
    return {{"wall_time_s", seconds()}, {"members", std::to_string(e.part.count())}};
  }
  add_findings(domain.findings);
  const Members members(context.recipe, e.table, e.paths, base_domain, base);
  members.check();
  const std::vector<AnyDevice> each = one_of_each(flags.on);
  const MemberCost cost =
      cost_of_member(draft_plan(base_domain, members.base(), Settle::done), each.front(), flags.plan);
  const double finer = e.options.is_budget() ? std::max(1.0, std::pow(e.options.budget.cell_factor, -3.0)) : 1;
  const InFlight flight = in_flight(e.part.count(), flags.at_a_time, finer * cost.bytes, each);
  log_info(fmt::format("{} members ({} to {}), {} at a time: {}", e.part.count(), e.part.first, e.part.end - 1,
                       flight.count, flight.reason));
  if (flags.plan) {
    for (const std::string& line : lines_of(cost, e.part.count(), flight.count)) log_info(line);
    return {};
  }
  if (context.check_only) return {};
  EnsembleCounts counts = fresh_counts(context, e, domain, with_map_threshold(base, domain));
  members.note_changes(counts);
  take_up(e, flags, counts);
  counts.other_cells = e.options.is_budget();
  counts.deposit_quantum = e.options.is_budget() ? 1e-6 : e.options.keeps("deposits") ? 1e-3 : 0;
  const auto unfinished = e.paths.unfinished(e.part);
  const OwnEnd saving("finished members are saved");
  keep_runs(context, members, e.options, e.paths, make_device(flags.on), counts);
  const bool is_whole = count_members(e, members, devices_for(flight.count, flags.on), counts);
  say_findings(counts, e.table);
  if (!is_whole) stop(counts, unfinished);
  judge_failures(counts, e);
  say_edges(counts, e.table);
  if (e.part.count() == counts.members) warn_of_unused("solve", base.accept, counts.findings);
  write_counts(e.counts, counts);
  remove_for_good(unfinished);
  context.results.push_back(e.counts);
  log_info(fmt::format("{} members counted, {} failed, in {} s", counts.count(MemberState::counted),
                       counts.count(MemberState::failed), seconds()));
  return {{"wall_time_s", seconds()}, {"members", std::to_string(counts.count(MemberState::counted))}};
}

}  // namespace talus::solver
