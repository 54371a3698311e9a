// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_stage.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "common/stage/machine.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/plan/describe_plan.hpp"

namespace talus::solver {
namespace {

std::vector<Profile::Kernel> by_time(const Profile& profile) {
  std::vector<Profile::Kernel> kernels = profile.kernels();
  std::stable_sort(kernels.begin(), kernels.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  return kernels;
}

double rate(const Profile::Kernel& k) { return k.seconds > 0 ? k.bytes / k.seconds : 0; }

/// The profile in lines of text. `copy` is the bandwidth of a copy where the run was [B/s].
std::vector<std::string> profile_lines(const RunSummary& summary, const Profile& profile, double copy) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& name, double seconds) {
    lines.push_back(fmt::format("  {:28} {:9.3f} s {:5.1f} %", name, seconds,
                                summary.wall_time > 0 ? 100 * seconds / summary.wall_time : 0));
  };
  lines.push_back("where the time went:");
  double named = 0;
  for (const auto& [name, seconds] : summary.profile) {
    if (!(seconds > 0)) continue;
    named += seconds;
    line(name, seconds);
  }
  line("everything else", summary.wall_time - named);
  lines.push_back(fmt::format("kernels, and the bytes each has to move against a copy's {:.0f} GB/s:", copy / 1e9));
  lines.push_back(
      fmt::format("  {:28} {:>9} {:>10} {:>10} {:>7} {:>7}", "", "calls", "time [s]", "each [us]", "GB/s", "share"));
  const std::vector<Profile::Kernel> kernels = by_time(profile);
  double all = 0, rest = 0;
  for (const auto& k : kernels) all += k.seconds;
  for (const auto& k : kernels) {
    if (k.seconds < 0.005 * all) {
      rest += k.seconds;
      continue;
    }
    lines.push_back(fmt::format("  {:28} {:9} {:10.3f} {:10.1f}", k.name, k.calls, k.seconds,
                                1e6 * k.seconds / static_cast<double>(k.calls)));
    if (k.bytes > 0) lines.back() += fmt::format(" {:7.0f} {:5.0f} %", rate(k) / 1e9, 100 * rate(k) / copy);
  }
  if (rest > 0) lines.push_back(fmt::format("  {:28} {:>9} {:10.3f}", "all others", "", rest));
  lines.push_back(fmt::format("memory where the steps were taken, {:.1f} MB:", summary.memory / 1e6));
  for (const auto& [owner, bytes] : summary.memory_of)
    lines.push_back(fmt::format("  {:28} {:9.1f} MB", owner, bytes / 1e6));
  return lines;
}

/// This function reports what was measured, in words and as profile.csv. `before`: age of the process as the run began
/// [s].
void report_profile(const RunSummary& summary, const AnyDevice& device, double before,
                    const std::filesystem::path& out) {
  log_info(fmt::format("process: {:.2f} s before the run, {:.2f} s in it, {:.2f} s for its files", before,
                       summary.wall_time, age_of_process() - before - summary.wall_time));
  Profile& profile = device.profile();
  profile.turn_off();
  const double copy = device.is_gpu() ? copy_bandwidth(device.gpu()) : copy_bandwidth(device.cpu());
  for (const std::string& text : profile_lines(summary, profile, copy)) log_info(text);
  write_text(out / "profile.csv", profile_csv(profile, copy));
}

/// What the used recipe says of a run that is whole.
Facts facts_of(const RunSummary& summary) {
  return {{"id", fact(summary.provenance, run_id)},
          {"on", summary.on},
          {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)},
          {"steps", fmt::format("{}", summary.steps)},
          {"stop_reason", summary.stop_reason}};
}

}  // namespace

std::string profile_csv(const Profile& profile, double copy) {
  std::string text = "kernel,phase,calls,seconds,bytes,share_of_copy_bandwidth\n";
  for (const auto& k : by_time(profile)) {
    text += fmt::format("{},{},{},{:.6g},", k.name, profile.phases()[k.phase].name, k.calls, k.seconds);
    text += k.bytes > 0 ? fmt::format("{:.6g},{:.4f}\n", k.bytes, rate(k) / copy) : ",\n";
  }
  return text;
}

void add_findings_of(const Plan& plan) {
  add_findings(plan.domain->findings);
  for (const Finding& finding : plan.findings) add_finding(finding);
}

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
    warn("checkpoint-not-taken-up", fmt::format("{} The run begins anew", error.what()));
  }
}

Facts run_in_time(StageContext& context, const RunFlags& flags, const std::shared_ptr<const Plan>& plan,
                  const AnyDevice& device) {
  const SolveOptions& options = plan->options;
  const Findings found("solve");
  std::vector<std::string> accept = options.accept;
  const bool accepts_torn = std::erase(accept, torn_body) > 0;  // of which the run itself tells
  warn_of_unused("solve", accept, plan->findings);
  if (flags.plan) {
    const History recorded(options, plan->scene);  // refuses what cannot be recorded
    for (const std::string& text : describe_plan(*plan, device)) log_info(text);
    add_findings_of(*plan);
    return {};
  }
  for (const std::string& text : summary_lines(*plan, device)) log_info(text);
  add_findings_of(*plan);
  const RunPaths paths(context.out);
  const std::string fingerprint = fingerprint_of(inputs_of(options, context.out).front(), options);
  if (flags.profile) device.profile().turn_on();
  Simulation simulation(plan, device, paths, fingerprint);
  if (context.check_only) return {};
  take_up(simulation, flags, paths, fingerprint);
  Facts facts = plan->domain->provenance;
  const Facts own = made_by(context, options);
  facts.insert(facts.end(), own.begin(), own.end());
  const double before = age_of_process();
  const RunSummary summary =
      simulation.run(context.recipe.scene_name(), context.recipe.title(), facts, findings_so_far());
  log_info(fmt::format("{} at t = {:.2f} s after {} steps in {:.1f} s", summary.stop_reason, summary.time_end,
                       summary.steps, summary.wall_time));
  if (accepts_torn) warn_of_unused("solve", {torn_body}, summary.findings);
  if (flags.profile) report_profile(summary, device, before, context.out);
  context.results.push_back(paths.run);
  return facts_of(summary);
}

}  // namespace talus::solver
