// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/stability_stage.hpp"

#include <chrono>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"
#include "solver/run/stability/stability_products.hpp"

namespace talus::solver {
namespace {

/// What run.h5 says of a search beside its maps; `facts` are those of the outcome.
RunSummary summary_of_search(const StageContext& context, const SolveOptions& options, const AnyDevice& device,
                             const std::vector<Facts>& facts) {
  RunSummary summary;
  summary.scene = context.recipe.scene_name();
  summary.title = context.recipe.title();
  summary.on = device.is_gpu() ? gpu_name(device.gpu().index()) : hardware();
  summary.precision = "double";
  summary.version = version();
  summary.stop_reason = "factor of safety by strength reduction";
  summary.material = options.material.sentence();
  summary.bed = options.base.sentence();
  for (const Facts& some : facts) summary.provenance.insert(summary.provenance.end(), some.begin(), some.end());
  return summary;
}

}  // namespace

Facts find_stability(StageContext& context, const SolveOptions& options, const AnyDevice& device,
                     const Domain& domain) {
  const Findings findings("solve");
  StabilitySearch search(domain, options, device);
  log_info(
      fmt::format("factor of safety: {} material points; tan(friction) and cohesion are divided until no "
                  "equilibrium is left",
                  search.scene().points.size()));
  add_findings(domain.findings, "coarse-grid");
  if (context.check_only) return {};
  const auto begun = std::chrono::steady_clock::now();
  const Stability found = search.run();
  const CriticalMass mass = critical_mass(search.scene(), search.options(), found.failure);
  for (const std::string& line : stability_lines(found, mass)) log_info(line);
  warn_of_stability(found, mass);
  const Facts outcome = stability_facts(found, mass), id{{run_id, new_run_id()}};
  RunSummary summary =
      summary_of_search(context, options, device, {domain.provenance, id, made_by(context, options), outcome});
  summary.places = domain.obstacles;
  summary.findings = findings_so_far();
  summary.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  const auto run = RunPaths(context.out).run, json = context.out / "stability.json";
  write_stability_run(run, domain, search, mass, summary, device);
  write_text(json, stability_json(summary.scene, found, mass));
  context.results = {run, json};
  Facts used{{"id", id.front().second}, {"on", summary.on}, {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)}};
  used.insert(used.end(), outcome.begin(), outcome.end());
  return used;
}

}  // namespace talus::solver
