// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/gravity_loading.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

/// The loaded strains go to the points of the start, which are in another order, as far as their law keeps them.
void take_strains(const ParticleState& loaded, const SolveOptions& options, ParticleState& start) {
  for (std::size_t q = 0; q < loaded.size(); ++q) {
    const auto p = static_cast<std::size_t>(loaded.id[q]);
    const int material = start.material[p];
    const MaterialOptions& own =
        material > 0 ? options.parts[static_cast<std::size_t>(material) - 1].material : options.material;
    const auto& e = loaded.elastic;
    const Sym3<double> kept = after_loading(own.model, {e[0][q], e[1][q], e[2][q], e[3][q], e[4][q], e[5][q]});
    const double values[6] = {kept.xx, kept.yy, kept.zz, kept.xy, kept.yz, kept.xz};
    for (std::size_t a = 0; a < 6; ++a) start.elastic[a][p] = values[a];
    start.log_volume[p] = loaded.log_volume[q];
  }
}

}  // namespace

ParticleState loaded_by_gravity(const Scene& scene, const SolveOptions& options, const AnyDevice& device) {
  Scene resting = scene;
  resting.shaking = {};
  for (auto& component : resting.points.velocity) std::fill(component.begin(), component.end(), 0.0);
  const SolverSettings settings = make_settings(options, resting.grid);
  const auto loader = make_solver(resting, for_gravity_loading(settings, options.gravity_loading_steps), device);
  loader->set_next_event(1);
  log_info(fmt::format("gravity is brought on first, in {} steps at least", options.gravity_loading_steps));
  std::int64_t newton = 0, linear = 0;
  while (loader->clock().time < 1) {
    stop_if_interrupted("bringing on gravity");
    const BatchReport batch = loader->advance();
    newton += batch.stats.newton;
    linear += batch.stats.linear;
  }
  ParticleState start = scene.points;
  take_strains(loader->state().points, options, start);
  log_info(fmt::format("gravity loading: {} steps, {} Newton and {} linear iterations", loader->clock().step, newton,
                       linear));
  return start;
}

}  // namespace talus::solver
