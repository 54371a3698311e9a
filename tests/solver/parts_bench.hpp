// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A block on a slope with all that a step of it works on, as an implicit solver would hold it.
#pragma once

#include "solver/boundary/surface_contact.hpp"
#include "solver/implicit/contact_set.hpp"
#include "solver/integrator/settings.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

inline SolveOptions options_of(Integrator integrator) {
  SolveOptions o = elastic_options(1e6, integrator);
  o.shape = ShapeKind::quadratic;
  o.implicit.step = 0.01;
  return o;
}

/// Particles, grid, bed and surfaces of a block on a slope, fitted to one another.
struct PartsBench {
  using Shape = Quadratic;
  CpuDevice device = CpuDevice::make();
  Scene scene;
  SolverSettings settings;
  Materials<double> materials;
  Particles<double, CpuDevice> points;
  SparseGrid<double, CpuDevice> grid;
  SurfaceContact<double, CpuDevice, Shape> surfaces;
  ContactImpulses<double, CpuDevice, Shape> impulses;
  SumSpace<CpuDevice> sums{device};

  static Scene make(const SolveOptions& o) {
    return make_scene(
        filled(ground(14, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.6 * x; }), {4, 8, 4, 8, 0, 3}), o);
  }
  static ParticleNeeds needs(const IntegratorSettings& s) {
    ParticleNeeds n = s.needs;
    n.accelerations = true;
    return n;
  }
  explicit PartsBench(const SolveOptions& o)
      : scene(make(o)),
        settings(make_settings(o, scene.grid)),
        materials(settings.common.materials.in<double>()),
        points(device, needs(settings.common)),
        grid(device, scene.grid, {.columns = 0, .layers = 0}),
        surfaces(device, scene.contacts, scene.grid, {}, false),
        impulses(device) {
    points.upload(scene.points);
    grid.fit(points, 0);
  }

  /// The parts as a step takes them; they refer to this bench.
  StepParts<double, CpuDevice, Shape> parts() {
    return {.device = device,
            .settings = settings.common,
            .controls = settings.implicit,
            .points = points,
            .grid = grid,
            .materials = materials,
            .dilatant = false,
            .surfaces = surfaces,
            .impulses = impulses,
            .sums = sums,
            .cell = {.spacing = scene.grid.spacing,
                     .layer_height = scene.grid.layer_height,
                     .layer_mass = materials.list[0].density * scene.grid.layer_height,
                     .full_base = Shape::edge_share * materials.list[0].density}};
  }
};

}  // namespace talus::solver::testing
