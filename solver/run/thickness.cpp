// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/thickness.hpp"

#include "solver/integrator/point_sums.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

std::vector<double> thickness_of(const Scene& scene, const SolveOptions& options, const ParticleState& points,
                                 const std::function<bool(std::size_t)>& counts) {
  const GridShape& shape = scene.grid;
  std::vector<double> thickness(static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows), 0.0);
  Particles<double, CpuDevice> held(CpuDevice::make(), {.boxes = options.shape == ShapeKind::gimp});
  held.upload(points);
  with_shape(options.shape, [&](auto kind) {
    const ScatterThickness<double, decltype(kind)> scatter{held.view(), shape.columns, thickness.data()};
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (counts(p)) scatter(static_cast<int>(p));
    }
    return 0;
  });
  for (double& value : thickness) value /= shape.spacing * shape.spacing;
  return thickness;
}

}  // namespace talus::solver
