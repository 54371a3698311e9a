// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/shaking_words.hpp"
#include "solver/run/stiffness.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

std::string span(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string flow_words(const SolveOptions& o) {
  if (o.flow_integrator() == Integrator::explicit_) return fmt::format("explicit, {:g} of the CFL step", o.cfl);
  return fmt::format("explicit, inertia implicit along columns (kappa = {:g}), {:g} of the CFL step of the cells",
                     o.kappa, o.cfl);
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

/// The steps and seconds of a trial.
struct Trial {
  double step = 0;     // length of the last one [s]
  double seconds = 0;  // each
  std::size_t bytes = 0;
};

Trial try_steps(const Scene& scene, const SolveOptions& o, const AnyDevice& device) {
  const auto solver = make_solver(scene, o, device);
  solver->set_next_event(o.end_time);
  const auto seconds_since = [](auto begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  solver->advance();  // storage, and on a GPU the first launch of every kernel
  const auto first = solver->clock();
  const auto begun = std::chrono::steady_clock::now();
  Clock last = first;
  while (seconds_since(begun) < 0.5 && last.time < o.end_time && !(last.halt == failed)) last = solver->advance().clock;
  const double steps = static_cast<double>(last.step - first.step);
  return {last.step_size, steps > 0 ? seconds_since(begun) / steps : 0, solver->bytes()};
}

}  // namespace

double records_of(const SolveOptions& o) {
  const double per_second =
      1 / o.frame_interval + 1 / o.history_interval + (o.checkpoint_interval > 0 ? 1 / o.checkpoint_interval : 0);
  return o.end_time * per_second;
}

std::vector<std::string> features(const Domain& domain, const SolveOptions& o) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& name, const std::string& words) {
    lines.push_back(fmt::format("{:<12} {}", name, words));
  };
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
  if (o.ground_contact == GroundContact::points) add("ground", "met by points between the nodes");
  for (const ObstacleOptions& obstacle : o.obstacles)
    add("obstacle", fmt::format("{}, {:g} deg", obstacle.name, obstacle.friction_angle));
  for (const GaugeOptions& gauge : o.gauges)
    add("gauge", fmt::format("{}, at x {}, y {}", gauge.name, gauge.x, gauge.y));
  if (!o.loads.empty()) add("loads", fmt::format("{}", o.loads.size()));
  if (o.deterministic) add("sums", "in a fixed order (deterministic)");
  if (o.vdb_frames) add("frames", "points as .vdb too");
  return lines;
}

std::vector<std::string> plan(const Domain& domain, const SolveOptions& o, const AnyDevice& device) {
  std::vector<std::string> lines = features(domain, o);
  const Scene scene = make_scene(domain, o);
  if (scene.shaking.acts()) lines.push_back(fmt::format("{:<12} {}", "shaking", shaking_words(scene.shaking)));
  const History recorded(o, scene);  // refuses what cannot be recorded
  for (const std::string& note : scene.contacts.notes) lines.push_back(note);
  const Trial trial = try_steps(scene, o, device);
  const auto add = [&](const std::string& name, const std::string& words) {
    lines.push_back(fmt::format("{:<12} {}", name, words));
  };
  const double volume = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  const double cell = scene.grid.spacing * scene.grid.spacing * scene.grid.layer_height;
  add("points", fmt::format("{}, {:.6g} m3", scene.points.size(), volume));
  add("cells",
      fmt::format("{} x {} columns of {:g} m, layers of {:g} m; the mass fills about {:.0f}, the grid around it at the "
                  "start has {} in {} blocks of columns",
                  scene.grid.columns, scene.grid.rows, scene.grid.spacing, scene.grid.layer_height, volume / cell,
                  scene.active.cell_count(), scene.active.block_count()));
  add("memory",
      fmt::format("{:.1f} MB now, on the {}", static_cast<double>(trial.bytes) / 1e6, device.is_gpu() ? "GPU" : "CPU"));
  const double records = records_of(o);
  double fewest = o.end_time / o.implicit.step + records, most = fewest;
  if (abilities_of(o.integrator).obey_cfl) {
    const TerrainTables terrain = make_terrain_tables(scene.grid);
    const FirstWaves waves = first_waves(o);
    const double fast = lowest_stiffness(domain, o).speed;
    const auto step_at = [&](double speed) {
      return std::min(o.cfl / first_rate(scene.grid, terrain, scene.points, waves, speed), o.largest_step);
    };
    fewest = o.end_time / step_at(0) + records;
    most = o.end_time / std::min(step_at(fast), trial.step > 0 ? trial.step : 1e30) + records;
    add("step",
        fmt::format("{:.3g} s at rest (waves of {:.0f} m/s), {:.3g} s at the {:.0f} m/s that the energy line allows",
                    step_at(0), waves.speed, step_at(fast), fast));
  } else {
    add("step", fmt::format("{:.3g} s, cut where it does not converge", o.implicit.step));
  }
  add("count", fewest < 0.99 * most ? fmt::format("{:.0f} to {:.0f} steps to {:g} s", fewest, most, o.end_time)
                                    : fmt::format("{:.0f} steps to {:g} s", most, o.end_time));
  if (trial.seconds > 0) {
    add("time", fmt::format("{} to {} at {:.3g} ms a step, as long as no more matter is moving than at the start",
                            span(fewest * trial.seconds), span(most * trial.seconds), 1e3 * trial.seconds));
  }
  return lines;
}

}  // namespace talus::solver
