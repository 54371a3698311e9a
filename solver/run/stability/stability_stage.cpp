// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/stability_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "common/run/mobility.hpp"
#include "common/stage/findings.hpp"
#include "solver/run/simulation.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

/// Of the ground: a mass this large is no failure of a part of it, or what fails reaches the edge of the scene.
constexpr double nearly_all = 0.9;

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null"; }

std::string trial_json(const StabilityTrial& t) {
  return fmt::format(
      "{{\"factor\": {:.6g}, \"equilibrium\": {}, \"by_motion\": {}, \"newton_iterations\": {}, "
      "\"largest_way_m\": {}}}",
      t.factor, t.holds, t.by_motion, t.newton, t.way > 0 ? number(t.way) : "null");
}

/// Area and depth by the columns that the points stand in: maps spread a narrow strip over the cells beside it.
template <class Fails>
void measure_columns(const Scene& scene, const Fails& fails, CriticalMass& mass) {
  struct Column {
    double top = -1e300, bottom = 1e300;
  };
  std::map<std::pair<int, int>, Column> columns;
  const ParticleState& points = scene.points;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!fails(p)) continue;
    Column& column = columns[{points.cell[0][p], points.cell[1][p]}];
    const double height = points.cell[2][p] + points.offset[2][p], half = 0.5 * points.extent[2][p];
    column.top = std::max(column.top, height + half);
    column.bottom = std::min(column.bottom, height - half);
  }
  mass.area = static_cast<double>(columns.size()) * scene.grid.spacing * scene.grid.spacing;
  for (const auto& [place, column] : columns)
    mass.depth = std::max(mass.depth, (column.top - column.bottom) * scene.grid.layer_height);
}

/// What run.h5 says of a search beside its maps; `facts` are those of the outcome.
RunSummary summary_of_search(const StageContext& context, const Domain& domain, const SolveOptions& options,
                             const AnyDevice& device, const std::vector<Facts>& facts) {
  RunSummary summary;
  summary.scene = context.recipe.scene_name();
  summary.title = context.recipe.title();
  summary.on = hardware_of(device);
  summary.precision = "double";
  summary.version = version();
  summary.stop_reason = "factor of safety by strength reduction";
  summary.material = options.material.sentence();
  summary.bed = bed_sentence(domain, options);
  for (const Facts& some : facts) summary.provenance.insert(summary.provenance.end(), some.begin(), some.end());
  return summary;
}

/// The lines for the log: factor, bracket, mass.
std::vector<std::string> stability_lines(const Stability& found, const CriticalMass& mass) {
  std::vector<std::string> lines;
  const FactorBracket& f = found.factor;
  if (found.stiffening > 1)
    lines.push_back(
        fmt::format("moduli times {:.3g}, so that the ground strains by no more than 0.001 under its weight; "
                    "the factor does not depend on them",
                    found.stiffening));
  if (!f.closed()) return lines;
  lines.push_back(fmt::format("factor of safety {:.3f} (equilibrium at {:.4f}, none at {:.4f}; {} trials)", f.middle(),
                              f.low, f.high, found.trials.size()));
  if (!mass.thickness.empty())
    lines.push_back(
        fmt::format("what fails first: {:.4g} m3 ({:.0f} % of the ground), {:.4g} m2, {:.3g} m deep at most",
                    mass.volume, 100 * mass.share, mass.area, mass.depth));
  return lines;
}

/// The outcome as name and value, for run.h5 and *.used.toml.
std::vector<std::pair<std::string, std::string>> stability_facts(const Stability& found, const CriticalMass& mass) {
  std::vector<std::pair<std::string, std::string>> facts{{"stability.lower_factor", number(found.factor.low)},
                                                         {"stability.upper_factor", number(found.factor.high)}};
  if (!found.factor.closed()) return facts;
  facts.insert(facts.begin(), {"stability.factor_of_safety", fmt::format("{:.4f}", found.factor.middle())});
  facts.emplace_back("stability.trials", std::to_string(found.trials.size()));
  facts.emplace_back("stability.failure_confirmed", found.failure.moves ? "yes" : "no");
  facts.emplace_back("stability.critical_volume_m3", number(mass.volume));
  facts.emplace_back("stability.critical_area_m2", number(mass.area));
  facts.emplace_back("stability.critical_depth_m", number(mass.depth));
  return facts;
}

/// The text of stability.json: factor with bracket, trials, mass; lengths in m, volumes in m3.
std::string stability_json(const std::string& scene, const Stability& found, const CriticalMass& mass) {
  std::string trials;
  for (const StabilityTrial& t : found.trials) trials += (trials.empty() ? "\n    " : ",\n    ") + trial_json(t);
  std::string name;
  for (const char c : scene) {
    if (c == '"' || c == '\\') name += '\\';
    name += c;
  }
  const bool closed = found.factor.closed();
  return fmt::format(
      "{{\n  \"scene\": \"{}\",\n  \"factor_of_safety\": {},\n  \"lower_factor\": {},\n  \"upper_factor\": {},\n"
      "  \"failure_confirmed\": {},\n  \"critical_volume_m3\": {},\n  \"critical_area_m2\": {},\n"
      "  \"critical_depth_m\": {},\n  \"stiffening\": {},\n  \"trials\": [{}\n  ]\n}}\n",
      name, closed ? number(found.factor.middle()) : "null", number(found.factor.low), number(found.factor.high),
      found.failure.moves, number(mass.volume), number(mass.area), number(mass.depth), number(found.stiffening),
      trials);
}

/// This function writes run.h5: the ground at rest as a run of no steps, with the maps of the mass that fails.
void write_stability_run(const std::filesystem::path& file, const Domain& domain, const StabilitySearch& search,
                         const CriticalMass& mass, RunSummary summary, const AnyDevice& device) {
  const Scene& scene = search.scene();
  const SolveOptions& options = search.options();
  const auto solver = make_solver(scene, options, device);
  const SolverState state = solver->state();
  const std::vector<double> thickness = solver->thickness();
  History history(options, scene);
  const RunMemory nothing;
  history.record({.time = 0,
                  .clock = state.clock,
                  .energies = solver->energies(),
                  .step_over_cfl = 0,
                  .counted = nothing,
                  .solver = *solver});
  const RunEnd end{
      .domain = domain, .options = options, .scene = scene, .state = state, .initial_thickness = thickness};
  RunMaps maps = final_maps(end, thickness);
  maps.peak_thickness = thickness;
  maps.critical_thickness = mass.thickness;
  maps.failure_displacement = mass.displacement;
  summary.particles = static_cast<std::int64_t>(scene.points.size());
  summary.density = options.material.density;
  summary.volume_released = summary.volume_final = slide_volumes(end, 0).released;
  summary.memory = static_cast<double>(solver->bytes());
  RunWriter writer(file);
  writer.append_thickness(0, scene.map, thickness);
  writer.finish(maps, history.rows(), summary);
}

}  // namespace

CriticalMass critical_mass(const Scene& scene, const SolveOptions& options, const Failure& failure) {
  CriticalMass mass;
  if (failure.shares.empty()) return mass;
  const ParticleState& points = scene.points;
  const auto fails = [&](std::size_t p) { return failure.shares[p] >= 0.5; };
  mass.thickness = thickness_of(scene, options, points, fails);
  const std::vector<double> all = thickness_of(scene, options, points, [](std::size_t) { return true; });
  ParticleState moved = points;
  for (std::size_t p = 0; p < points.size(); ++p) moved.volume[p] *= failure.shares[p];
  mass.displacement = thickness_of(scene, options, moved, [](std::size_t) { return true; });
  const double covered = options.map_threshold.value_or(covering_thickness({}));
  for (std::size_t c = 0; c < all.size(); ++c)
    mass.displacement[c] = all[c] > covered ? mass.displacement[c] / all[c] : 0;
  measure_columns(scene, fails, mass);
  for (std::size_t p = 0; p < points.size(); ++p) mass.volume += fails(p) ? points.volume[p] : 0;
  mass.share = mass.volume / std::accumulate(points.volume.begin(), points.volume.end(), 0.0);
  return mass;
}

void warn_of_stability(const Stability& found, const CriticalMass& mass) {
  const FactorBracket& f = found.factor;
  if (!(f.low > 0))
    warn("no-equilibrium",
         fmt::format("no factor of safety: the ground finds no equilibrium even with its strength "
                     "times {:.3g}. Look for loose points at a rim, or for ground without a wall beside it",
                     1 / f.high),
         {{"largest_factor_tried", f.high, "1"}});
  if (!std::isfinite(f.high))
    warn("no-failure",
         fmt::format("no factor of safety: the ground rests even with its strength over {:.4g}. It is "
                     "level, or held by what has no strength to divide",
                     f.low),
         {{"largest_factor_tried", f.low, "1"}});
  if (mass.share > nearly_all)
    warn("all-ground-fails",
         fmt::format("{:.0f} % of the ground fails at once: the scene ends where the slide may not. Take "
                     "in more ground, unless all of it lies on a weak bed",
                     100 * mass.share),
         {{"share", mass.share, "1"}});
}

Facts find_stability(StageContext& context, const SolveOptions& options, const AnyDevice& device,
                     const Domain& domain) {
  const Findings findings("solve");
  StabilitySearch search(domain, options, device);
  log_info(
      fmt::format("factor of safety: {} material points; tan(friction) and cohesion are divided until no "
                  "equilibrium is left",
                  search.scene().points.size()));
  add_findings(domain.findings);
  if (context.check_only) return {};
  const RunTimer timer;
  const Stability found = search.run();
  const CriticalMass mass = critical_mass(search.scene(), search.options(), found.failure);
  for (const std::string& line : stability_lines(found, mass)) log_info(line);
  warn_of_stability(found, mass);
  const Facts outcome = stability_facts(found, mass), id{{run_id, new_run_id()}};
  RunSummary summary =
      summary_of_search(context, domain, options, device, {domain.provenance, id, made_by(context, options), outcome});
  summary.places = domain.obstacles;
  summary.findings = findings_so_far();
  summary.wall_time = timer.seconds();
  const auto run = RunPaths(context.out).run, json = context.out / "stability.json";
  write_stability_run(run, domain, search, mass, summary, device);
  write_text(json, stability_json(summary.scene, found, mass));
  context.results = {run, json};
  Facts used{{"id", id.front().second}, {"on", summary.on}, {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)}};
  used.insert(used.end(), outcome.begin(), outcome.end());
  return used;
}

}  // namespace talus::solver
