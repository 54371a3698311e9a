// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/loads.hpp"

#include <algorithm>
#include <cstddef>

namespace talus::solver {

std::vector<Vec3<double>> load_densities(const std::vector<Load>& loads, const std::vector<double>& volumes,
                                         double time) {
  std::vector<Vec3<double>> densities;
  for (std::size_t l = 0; l < volumes.size(); ++l) {
    const Load& load = loads[l];
    const double scale = (load.ramp > 0 ? std::clamp(time / load.ramp, 0.0, 1.0) : 1.0) / volumes[l];
    densities.push_back({load.force.x * scale, load.force.y * scale, load.force.z * scale});
  }
  return densities;
}

bool loads_jump(const std::vector<Load>& loads, const std::vector<double>& volumes, double time) {
  const auto jumps = [time](const Load& load) { return time == 0 && !(load.ramp > 0); };
  return std::any_of(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(volumes.size()), jumps);
}

}  // namespace talus::solver
