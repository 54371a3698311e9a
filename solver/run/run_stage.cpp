// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_stage.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/run/places.hpp"
#include "common/stage/acceptance.hpp"
#include "solver/parallel/bandwidth.hpp"
#include "solver/run/advice.hpp"
#include "solver/run/inflow_words.hpp"
#include "solver/run/plan.hpp"
#include "solver/run/plausible.hpp"
#include "solver/run/profile_report.hpp"
#include "solver/run/recorders/stretch.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"
#include "solver/run/step_choice.hpp"
#include "solver/run/stiffness_check.hpp"
#include "solver/run/trial.hpp"
#include "solver/run/warnings.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

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

/// One sentence on what will run: points, cells, first step.
void log_plan(const Domain& domain, const SolveOptions& o, const AnyDevice& device) {
  const Scene scene = make_scene(domain, o);
  const TerrainTables terrain = make_terrain_tables(scene.grid);
  const FirstWaves waves = first_waves(o);
  const double step = std::min(o.cfl / first_rate(scene.grid, terrain, scene.points, waves, 0), o.largest_step);
  const double volume = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  log_info(fmt::format("{} material points, {:.0f} m3; grid {} x {} columns of {:g} m, layers of {:g} m",
                       scene.points.size(), volume, scene.grid.columns, scene.grid.rows, scene.grid.spacing,
                       scene.grid.layer_height));
  for (const InflowSummary& inflow : scene.inflow.summaries) log_info("inflow " + inflow_words(inflow));
  const auto whole = [](double number) {
    return fmt::format(fmt::runtime(number < 1e9 ? "{:.0f}" : "{:.3g}"), number);
  };
  log_info(fmt::format("wave speed {} m/s, first step {:.3g} s, about {} steps, on the {}", whole(waves.speed), step,
                       whole(o.end_time / step + records_of(o)), device.is_gpu() ? "GPU" : "CPU"));
}

/// This function says what the scene is warned of. What is said here of the run goes into its results: the facts
/// "warning.solve.N" and "advice.NAME".
void log_warnings(Domain& domain, const SolveOptions& asked, const SolveOptions& o) {
  say_warnings_of_domain(domain);
  Facts said;
  std::vector<std::string> texts = warnings(domain, o);
  if (std::string unkept = unkept_accuracy(domain, asked); !unkept.empty()) texts.push_back(std::move(unkept));
  for (const std::string& text : texts) {
    log_warning(text);
    said.emplace_back(fmt::format("warning.solve.{}", said.size()), text);
  }
  for (const auto& [name, words] : advice(domain, o)) {
    log_info("advice: " + words);
    said.emplace_back("advice." + name, words);
  }
  domain.provenance.insert(domain.provenance.end(), said.begin(), said.end());
}

/// Where the gauges of the run are, for its report; obstacles that the domain was made with and that the run leaves
/// out are no longer among its places.
void add_places(Domain& domain, const SolveOptions& o) {
  std::erase_if(domain.provenance, [&](const auto& known) {
    return is_place(known.first) && std::none_of(o.obstacles.begin(), o.obstacles.end(), [&](const auto& obstacle) {
             return known.first == place_fact({"obstacle " + obstacle.name, {{{0, 0}}}}).first;
           });
  });
  for (const SectionOptions& s : o.sections) {
    MapPlace place{"section " + s.name, {{}}};
    for (std::size_t i = 0; i < s.x.size(); ++i) place.rings[0].push_back({s.x[i], s.y[i]});
    domain.provenance.push_back(place_fact(place));
  }
  for (std::size_t n = 0; n < o.inflows.size(); ++n) {
    const InflowOptions& i = o.inflows[n];
    domain.provenance.push_back(place_fact({"inflow " + inflow_name(i, n), {{{i.x[0], i.y[0]}, {i.x[1], i.y[1]}}}}));
  }
  for (const GaugeOptions& g : o.gauges) domain.provenance.push_back(place_fact({"gauge " + g.name, {{{g.x, g.y}}}}));
}

/// This function refuses what is implausible in a scene, and adds what is insisted on to the facts of its results.
void judge(Domain& domain, const SolveOptions& o, bool is_varied) {
  const Acceptance acceptance = judged_before_run(domain, make_scene(domain, o), o);
  if (!is_varied) acceptance.warn_of_unmet();
  const auto& facts = acceptance.facts();
  domain.provenance.insert(domain.provenance.end(), facts.begin(), facts.end());
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

Facts run_in_time(StageContext& context, const RunFlags& flags, const SolveOptions& options, const AnyDevice& device,
                  Domain& domain, const Facts& facts) {
  const SolveOptions settled = settle_steps(domain, options);
  judge(domain, settled, flags.is_varied);
  if (flags.plan) {
    for (const std::string& text : plan(domain, settled, device)) log_info(text);
    log_warnings(domain, options, settled);
    return {};
  }
  add_places(domain, settled);
  log_plan(domain, settled, device);
  log_warnings(domain, options, settled);
  const RunPaths paths(context.out);
  const std::string fingerprint = fingerprint_of(inputs_of(settled, context.out).front(), settled);
  if (flags.profile) device.profile().turn_on();
  Simulation simulation(domain, settled, device, paths, fingerprint);
  if (context.check_only) return {};
  take_up(simulation, flags, paths, fingerprint);
  const RunSummary summary =
      simulation.run(context.recipe.scene_name(), context.recipe.title(), made_by(context, settled, facts));
  log_info(fmt::format("{} at t = {:.2f} s after {} steps in {:.1f} s", summary.stop_reason, summary.time_end,
                       summary.steps, summary.wall_time));
  if (!flags.is_varied && accepts_torn_body(settled)) warn_of_unmet({torn_body}, summary.provenance);
  if (flags.profile) report_profile(summary, device, context.out);
  if (settled.material.stiffness_check) check_stiffness(domain, settled, device, context, paths.run);
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
