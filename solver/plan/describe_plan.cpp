// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/describe_plan.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include <fmt/format.h>

#include "solver/integrator/solver.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

/// Adds a line with a name in front.
struct Adder {
  std::vector<std::string>& lines;
  void operator()(const std::string& name, const std::string& words) const {
    lines.push_back(fmt::format("{:<12} {}", name, words));
  }
};

std::string flow_words(const SolveOptions& o) {
  if (o.flow_integrator() == Integrator::explicit_)
    return fmt::format("explicit, {:g} of the CFL step", o.step_over_cfl());
  return fmt::format("explicit, inertia implicit along columns (kappa = {:g}), {:g} of the CFL step of the cells",
                     column_kappa, o.step_over_cfl());
}

std::string integrator_words(const SolveOptions& o) {
  switch (o.integrator) {
    case Integrator::explicit_:
    case Integrator::column_implicit: return flow_words(o);
    case Integrator::newmark:
      return fmt::format("newmark, steps of {:g} s, {}", o.implicit.step,
                         o.implicit.newton_iterations == 1 ? "one linear solve each" : "Newton");
    case Integrator::quasi_static: return fmt::format("quasi-static, steps of {:g} s", o.implicit.step);
    default: return flow_words(o) + "; at rest newmark where that takes less work";
  }
}

}  // namespace

Trial try_steps(const Plan& plan, const AnyDevice& device, double seconds) {
  const Scene& scene = plan.scene;
  const SolveOptions& o = plan.options;
  const auto solver = make_solver(scene, o, device);
  solver->set_next_event(o.end_time);
  if (scene.points.size() == 0 && scene.inflow.any()) {  // steps of nothing say nothing
    const ParticleState first = scene.inflow.points_of(scene.inflow.pulses.front());
    solver->add(first, first_rate(scene.grid, solver->ground(), first, first_waves(o), 0));
  }
  const auto seconds_since = [](auto begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  solver->advance();  // storage, and on a GPU the first launch of every kernel
  const auto first = solver->clock();
  const auto begun = std::chrono::steady_clock::now();
  Clock last = first;
  while (seconds_since(begun) < seconds && last.time < o.end_time && !(last.alarms.halt == failed))
    last = solver->advance().clock;
  const double steps = static_cast<double>(last.step - first.step);
  return {last.step_size, steps > 0 ? seconds_since(begun) / steps : 0, solver->bytes()};
}

StepCount count_steps(const Plan& plan, double trial_step) {
  const SolveOptions& o = plan.options;
  const double records = records_of(o);
  StepCount count;
  count.fewest = count.most = o.end_time / o.implicit.step + records;
  if (!abilities_of(o.integrator).obey_cfl) return count;
  count.speed = plan.bound.speed;
  count.at_rest = explicit_step(plan.scene, o, 0);
  count.at_speed = explicit_step(plan.scene, o, count.speed);
  count.fewest = o.end_time / count.at_rest + records;
  count.most = o.end_time / std::min(count.at_speed, trial_step > 0 ? trial_step : 1e30) + records;
  return count;
}

std::string time_words(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

double records_of(const SolveOptions& o) {
  const double per_second =
      1 / o.frame_interval + 1 / o.history_interval + (o.checkpoint_interval > 0 ? 1 / o.checkpoint_interval : 0);
  return o.end_time * per_second;
}

std::string inflow_words(const InflowSummary& i) {
  return fmt::format(
      "{}: {:.4g} m3 from {:g} to {:g} s; at its largest {:.4g} m3/s over {:.3g} m of the line, {:.3g} m deep, at "
      "{:.3g} m/s (Froude number {:.2g})",
      i.name, i.volume, i.from, i.to, i.peak, i.width, i.depth, i.speed, i.froude);
}

std::string shaking_words(const Shaking& shaking) {
  const double begin = shaking.samples.front().time;
  return fmt::format("{} samples from {:g} to {:g} s, up to {:.3g} m/s2 and {:.3g} m/s", shaking.samples.size(), begin,
                     shaking.end(), shaking.peak_acceleration(), shaking.peak_velocity());
}

std::vector<std::string> features(const Plan& plan) {
  const Domain& domain = *plan.domain;
  const SolveOptions& o = plan.options;
  std::vector<std::string> lines;
  const Adder add{lines};
  add("steps", integrator_words(o));
  add("grid", fmt::format("{}, {} functions, {}, {} precision",
                          o.mapping == Mapping::cartesian ? "Cartesian" : "terrain-following",
                          o.shape == ShapeKind::linear ? "linear"
                          : o.shape == ShapeKind::gimp ? "gimp"
                                                       : "quadratic",
                          o.transfer == Transfer::apic ? "apic" : "flip",
                          o.precision == Precision::double_ ? "double" : "single"));
  add("material", o.material.words());
  for (const PartOptions& part : o.parts) add("  " + part.release, part.material.words());
  add("bed", o.base.words());
  if (o.water.flows()) add("water", o.water.words(o.material.density));
  if (o.water.level) add("still water", fmt::format("up to {:g} m", *o.water.level));
  for (const auto& [name, raster] : domain.bed) add("", name + " from a raster");
  if (domain.erodible > 0)
    add("erodible", fmt::format("{} of {} releases lie in the ground until they are taken along", domain.erodible,
                                domain.release_names.size()));
  if (o.gravity_loading_steps > 0)
    add("start", fmt::format("from equilibrium, {} load steps", o.gravity_loading_steps));
  if (o.gravity_ramp > 0) add("gravity", fmt::format("grows over {:g} s", o.gravity_ramp));
  if (o.damping > 0) add("damping", fmt::format("Cundall's, {:g}", o.damping));
  if (o.stress_update == StressUpdate::modified) add("stress", "from velocities mapped back (musl)");
  if (abilities_of(o.integrator).solve_systems && o.implicit.b_bar) add("volume", "means over cells (B-bar)");
  if (!o.walls.empty()) add("walls", fmt::format("{}", o.walls.size()));
  for (const ObstacleOptions& obstacle : o.obstacles)
    add("obstacle", fmt::format("{}, {:g} deg", obstacle.name, obstacle.friction_angle));
  for (const GaugeOptions& gauge : o.gauges)
    add("gauge", fmt::format("{}, at x {}, y {}", gauge.name, gauge.x, gauge.y));
  if (!o.loads.empty()) add("loads", fmt::format("{}", o.loads.size()));
  if (o.deterministic) add("sums", "in a fixed order (deterministic)");
  return lines;
}

std::vector<std::string> describe_plan(const Plan& plan, const AnyDevice& device) {
  std::vector<std::string> lines = features(plan);
  const Adder add{lines};
  const Scene& scene = plan.scene;
  const SolveOptions& o = plan.options;
  if (scene.shaking.acts()) add("shaking", shaking_words(scene.shaking));
  for (const InflowSummary& inflow : scene.inflow.summaries) add("inflow", inflow_words(inflow));
  for (const std::string& note : scene.contacts.notes) lines.push_back(note);
  const Trial trial = try_steps(plan, device, 0.5);
  const double volume = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  const double cell = scene.grid.spacing * scene.grid.spacing * scene.grid.layer_height;
  add("points", scene.inflow.any() ? fmt::format("{}, {:.6g} m3; {} more enter", scene.points.size(), volume,
                                                 scene.inflow.points.size())
                                   : fmt::format("{}, {:.6g} m3", scene.points.size(), volume));
  add("cells",
      fmt::format("{} x {} columns of {:g} m, layers of {:g} m; the mass fills about {:.0f}, the grid around it at the "
                  "start has {} in {} blocks of columns",
                  scene.grid.columns, scene.grid.rows, scene.grid.spacing, scene.grid.layer_height, volume / cell,
                  scene.active.cell_count(), scene.active.block_count()));
  add("memory",
      fmt::format("{:.1f} MB now, on the {}", static_cast<double>(trial.bytes) / 1e6, device.is_gpu() ? "GPU" : "CPU"));
  const StepCount count = count_steps(plan, trial.step);
  if (abilities_of(o.integrator).obey_cfl) {
    add("step", fmt::format("{:.3g} s at rest (waves of {:.0f} m/s), {:.3g} s at the {:.0f} m/s that the energy line "
                            "allows",
                            count.at_rest, first_waves(o).speed, count.at_speed, count.speed));
  } else {
    add("step", fmt::format("{:.3g} s, cut where it does not converge", o.implicit.step));
  }
  add("count", count.fewest < 0.99 * count.most
                   ? fmt::format("{:.0f} to {:.0f} steps to {:g} s", count.fewest, count.most, o.end_time)
                   : fmt::format("{:.0f} steps to {:g} s", count.most, o.end_time));
  if (trial.seconds > 0) {
    const bool fills = scene.points.size() == 0;  // the trial had the first pulse of an inflow
    add("time", fmt::format("{}{} to {} at {:.3g} ms a step, as long as no more matter is moving than {}",
                            fills ? "more than " : "", time_words(count.fewest * trial.seconds),
                            time_words(count.most * trial.seconds), 1e3 * trial.seconds,
                            fills ? "the first pulse of the inflow" : "at the start"));
  }
  return lines;
}

std::vector<std::string> summary_lines(const Plan& plan, const AnyDevice& device) {
  const Scene& scene = plan.scene;
  const SolveOptions& o = plan.options;
  const double step = explicit_step(scene, o, 0);
  const double volume = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  std::vector<std::string> lines{fmt::format(
      "{} material points, {:.0f} m3; grid {} x {} columns of {:g} m, layers of {:g} m", scene.points.size(), volume,
      scene.grid.columns, scene.grid.rows, scene.grid.spacing, scene.grid.layer_height)};
  for (const InflowSummary& inflow : scene.inflow.summaries) lines.push_back("inflow " + inflow_words(inflow));
  const auto whole = [](double number) {
    return fmt::format(fmt::runtime(number < 1e9 ? "{:.0f}" : "{:.3g}"), number);
  };
  lines.push_back(fmt::format("wave speed {} m/s, first step {:.3g} s, about {} steps, on the {}",
                              whole(first_waves(o).speed), step, whole(o.end_time / step + records_of(o)),
                              device.is_gpu() ? "GPU" : "CPU"));
  return lines;
}

}  // namespace talus::solver
