// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How often the points are sorted.
#pragma once

#include "solver/grid/sparse_grid.hpp"
#include "solver/parallel/for_each.hpp"

namespace talus::solver {

/// The steps between sorts on a GPU: it gains little by order within the cells, and sorting there takes as long as ten
/// steps.
inline constexpr int gpu_steps_between_sorts = 256;
/// The steps between sorts where many points keep a GPU busy: what lies apart costs more than sorting then.
inline constexpr int busy_gpu_steps_between_sorts = 32;
/// The steps between sorts on a GPU for a number of points: `busy_gpu_steps_between_sorts` where many points have wide
/// stencils.
template <class Shape>
int steps_between_sorts_on_gpu(int points) {
  return Shape::width > 2 && points >= points_that_keep_a_gpu_busy ? busy_gpu_steps_between_sorts
                                                                   : gpu_steps_between_sorts;
}
/// The steps between sorts on a CPU: in places of memory that lie apart, steps become slower.
inline constexpr int cpu_steps_between_sorts = 32;
/// The way that points may go before they are sorted: a sort takes as long as a dozen steps of a small scene, and more
/// empty columns are stored at the rim for it. Layers are fewer, for steps by columns go through them one by one.
template <class Device>
Drift drift_between_sorts(bool deterministic) {
  if (!Device::is_gpu || deterministic) return {};
  return {.columns = 6, .layers = 3};
}

}  // namespace talus::solver
