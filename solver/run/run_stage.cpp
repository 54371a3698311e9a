// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_stage.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/run/places.hpp"
#include "solver/parallel/bandwidth.hpp"
#include "solver/plan/describe_plan.hpp"
#include "solver/plan/plausible.hpp"
#include "solver/plan/warnings.hpp"
#include "solver/run/profile_report.hpp"
#include "solver/run/recorders/stretch.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"

namespace talus::solver {
namespace {

/// This function reports what was measured, in words and as profile.csv.
void report_profile(const RunSummary& summary, const AnyDevice& device, const std::filesystem::path& out) {
  Profile& profile = device.profile();
  profile.turn_off();
  const double copy = device.is_gpu() ? copy_bandwidth(device.gpu()) : copy_bandwidth(device.cpu());
  for (const std::string& text : profile_lines(summary, profile, copy)) log_info(text);
  write_text(out / "profile.csv", profile_csv(profile, copy));
}

/// This function logs what was settled, warnings and advice.
void log_findings(const Plan& plan) {
  say_warnings_of_domain(*plan.domain);
  for (const std::string& text : plan.warnings) log_warning(text);
  for (const auto& [name, words] : plan.advice) log_advice(words);
}

/// The places of a run for its report: those of the domain without obstacles that the run leaves out, then sections,
/// inflows and gauges.
Facts places_of(const SolveOptions& o) {
  Facts places;
  for (const SectionOptions& s : o.sections) {
    MapPlace place{"section " + s.name, {{}}};
    for (std::size_t i = 0; i < s.x.size(); ++i) place.rings[0].push_back({s.x[i], s.y[i]});
    places.push_back(place_fact(place));
  }
  for (std::size_t n = 0; n < o.inflows.size(); ++n) {
    const InflowOptions& i = o.inflows[n];
    places.push_back(place_fact({"inflow " + inflow_name(i, n), {{{i.x[0], i.y[0]}, {i.x[1], i.y[1]}}}}));
  }
  for (const GaugeOptions& g : o.gauges) places.push_back(place_fact({"gauge " + g.name, {{{g.x, g.y}}}}));
  return places;
}

/// What goes with the results: the facts of the domain, less its obstacles that the run leaves out, and those of the
/// plan: what was accepted, places, "warning.solve.N" and "advice.NAME".
Facts facts_of(const Plan& plan) {
  const SolveOptions& o = plan.options;
  Facts facts = plan.domain->provenance;
  facts.insert(facts.end(), plan.accepted.begin(), plan.accepted.end());
  std::erase_if(facts, [&](const auto& known) {
    return is_place(known.first) && std::none_of(o.obstacles.begin(), o.obstacles.end(), [&](const auto& obstacle) {
             return known.first == place_fact({"obstacle " + obstacle.name, {{{0, 0}}}}).first;
           });
  });
  const Facts places = places_of(o);
  facts.insert(facts.end(), places.begin(), places.end());
  for (std::size_t n = 0; n < plan.warnings.size(); ++n)
    facts.emplace_back(fmt::format("warning.solve.{}", n), plan.warnings[n]);
  for (const auto& [name, words] : plan.advice) facts.emplace_back("advice." + name, words);
  return facts;
}

}  // namespace

void take_up(Simulation& simulation, const RunFlags& flags, const RunPaths& paths, const std::string& fingerprint) {
  if (flags.restart) return simulation.resume(flags.restart->empty() ? paths.checkpoint : *flags.restart);
  if (!std::filesystem::exists(paths.checkpoint)) return;
  const auto head = look_at_checkpoint(paths.checkpoint);
  if (!head || head->fingerprint != fingerprint) {
    log_info(fmt::format("{}: {}; it stays until this run has one of its own, or is whole", paths.checkpoint.string(),
                         head ? "a checkpoint of another domain or other [solve] settings"
                              : "no checkpoint that this version can read"));
    return;
  }
  if (!flags.resume)
    throw DataError({fmt::format("{}: it holds this very run at t = {:.3f} s, step {}", paths.checkpoint.string(),
                                 head->time, head->step),
                     "a run from the start would throw it away",
                     "Go on from it with --restart, or remove it to begin anew"});
  try {
    simulation.resume(paths.checkpoint);
  } catch (const DataError& error) {
    log_warning(fmt::format("{} The run begins anew", error.what()));
  }
}

std::optional<std::filesystem::path> checkpoint_of(const RunFlags& flags, const std::filesystem::path& out) {
  if (!flags.restart) return std::nullopt;
  return flags.restart->empty() ? RunPaths(out).checkpoint : *flags.restart;
}

Facts run_in_time(StageContext& context, const RunFlags& flags, const std::shared_ptr<const Plan>& plan,
                  const AnyDevice& device, const Facts& insisted) {
  const SolveOptions& options = plan->options;
  if (!flags.is_varied) warn_of_unmet(accepted_before_run(options), plan->accepted);
  if (flags.plan) {
    const History recorded(options, plan->scene);  // refuses what cannot be recorded
    for (const std::string& text : describe_plan(*plan, device)) log_info(text);
    log_findings(*plan);
    return {};
  }
  for (const std::string& text : summary_lines(*plan, device)) log_info(text);
  log_findings(*plan);
  const RunPaths paths(context.out);
  const std::string fingerprint = fingerprint_of(inputs_of(options, context.out).front(), options);
  if (flags.profile) device.profile().turn_on();
  Simulation simulation(plan, device, paths, fingerprint);
  if (context.check_only) return {};
  take_up(simulation, flags, paths, fingerprint);
  Facts facts = facts_of(*plan);
  const Facts own = made_by(context, options, insisted);
  facts.insert(facts.end(), own.begin(), own.end());
  const RunSummary summary = simulation.run(context.recipe.scene_name(), context.recipe.title(), facts);
  log_info(fmt::format("{} at t = {:.2f} s after {} steps in {:.1f} s", summary.stop_reason, summary.time_end,
                       summary.steps, summary.wall_time));
  if (!flags.is_varied && accepts_torn_body(options)) warn_of_unmet({torn_body}, summary.provenance);
  if (flags.profile) report_profile(summary, device, context.out);
  context.results.push_back(paths.run);
  return facts_of(summary);
}

Facts facts_of(const RunSummary& summary) {
  return {{"id", fact(summary.provenance, run_id)},
          {"on", summary.on},
          {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)},
          {"steps", fmt::format("{}", summary.steps)},
          {"stop_reason", summary.stop_reason}};
}

}  // namespace talus::solver
